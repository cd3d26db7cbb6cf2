/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Semi-global matching (Hirschmueller 2008) of a cost volume C over 8 paths, penalties damped where the guide changes:
 *
 *     L(p, z) = C(p, z) + min(L(q, z), L(q, z -+ 1) + P1 E(p, q), min_k L(q, k) + P2 E(p, q)) - min_k L(q, k)
 *     E(p, q) = exp(-|A(p) - A(q)|_1 / 15) + 0.01,  P1 = .3 + .4 t,  P2 = 2
 *
 * q is the cell before p on the path. Down and up go two work-items, row after row, each with three paths at once; along
 * rows go as many as there are blocks of 8 rows.
 */
#include "low_picture.cl"

#define FLOOR 0.01f

/* edges[0..3]: E to the cell above, above left, above right, left. The sides of the guide must be mirrored.
 * Work-items (1, low height). */
__kernel void find_edges(__global const float *guide, __global float *edges, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    const size_t above = (size_t)max(y - 1, 0) * stride + SIDE;
    const size_t others[4] = {above, above - 1, above + 1, row - 1};
    for (int direction = 0; direction < 4; direction++)
        for (int x = -8; x < width + 8; x += 8) {
            float8 difference = 0.0f;
            for (int colour = 0; colour < 3; colour++)
                difference += fabs(READ_CELLS(guide + colour * picture + row + x) -
                                   READ_CELLS(guide + colour * picture + others[direction] + x));
            CELLS(edges + direction * picture + row + x) = quick_exp(difference * (-1.0f / 15.0f)) + FLOOR;
        }
}

/* L of one cell in the order of z: `here` and `below` are L(q, z) and L(q, z - 1) and move on. */
inline float8 step_path(float8 cost, float8 beyond, float8 small_step, float8 jump, float8 least, float8 *here,
                        float8 *below, float8 *next_least)
{
    const float8 value = cost + (min(min(*here, jump), min(*below, beyond) + small_step) - least);
    *below = *here;
    *here = beyond;
    *next_least = min(*next_least, value);
    return value;
}

/* The three paths that come from the row above, or from the one below: total = their sum. Work-items (1, 2): down, up.
 * scratch: for each of them L of the last row and of this, [2][3 paths][PLANES + 1: the last is min_k][stride]. A
 * path that enters the picture finds 0 before it, whereby L = C. */
__kernel void sweep_rows(__global const float *cost, __global const float *edges, __global const Noise *noise,
                         __global float *total_down, __global float *total_up, __global float *scratch, int width,
                         int height, int stride)
{
    const int up = (int)get_global_id(1);
    const size_t picture = (size_t)height * stride, path = (PLANES + 1) * (size_t)stride;
    __global float *total = up ? total_up : total_down;
    __global float *state = scratch + up * 6 * path;
    const float p1 = 0.3f + 0.4f * noise->t, p2 = 2.0f;
    for (size_t i = 0; i < 6 * path; i++)
        state[i] = 0.0f;

    for (int step = 0; step < height; step++) {
        const int y = up ? height - 1 - step : step;
        __global const float *before = state + (step % 2) * 3 * path + SIDE;
        __global float *after = state + (1 - step % 2) * 3 * path + SIDE;
        /* E between p and q is kept at the lower of them; from below, the two slanted ones change places. */
        __global const float *edge = edges + (size_t)(up ? min(y + 1, height - 1) : y) * stride + SIDE;
        for (int x = 0; x < width; x += 8) {
            const size_t cell = (size_t)y * stride + SIDE + x;
            const float8 straight = READ_CELLS(edge + x);
            const float8 left = up ? READ_CELLS(edge + 2 * picture + x - 1) : READ_CELLS(edge + picture + x);
            const float8 right = up ? READ_CELLS(edge + picture + x + 1) : READ_CELLS(edge + 2 * picture + x);
            __global const float *from0 = before + x, *from1 = before + path + x - 1, *from2 = before + 2 * path + x + 1;
            const float8 least0 = READ_CELLS(from0 + PLANES * stride), least1 = READ_CELLS(from1 + PLANES * stride),
                         least2 = READ_CELLS(from2 + PLANES * stride);
            float8 here0 = READ_CELLS(from0), here1 = READ_CELLS(from1), here2 = READ_CELLS(from2);
            float8 below0 = INFINITY, below1 = INFINITY, below2 = INFINITY;
            float8 next0 = INFINITY, next1 = INFINITY, next2 = INFINITY;
            for (int z = 0; z < PLANES; z++) {
                const int last = z + 1 == PLANES, next = last ? z : z + 1;
                const float8 value = READ_CELLS(cost + z * picture + cell);
                const float8 beyond0 = last ? INFINITY : READ_CELLS(from0 + next * stride);
                const float8 beyond1 = last ? INFINITY : READ_CELLS(from1 + next * stride);
                const float8 beyond2 = last ? INFINITY : READ_CELLS(from2 + next * stride);
                const float8 l0 = step_path(value, beyond0, p1 * straight, least0 + p2 * straight, least0, &here0,
                                            &below0, &next0);
                const float8 l1 =
                    step_path(value, beyond1, p1 * left, least1 + p2 * left, least1, &here1, &below1, &next1);
                const float8 l2 =
                    step_path(value, beyond2, p1 * right, least2 + p2 * right, least2, &here2, &below2, &next2);
                CELLS(after + z * stride + x) = l0;
                CELLS(after + path + z * stride + x) = l1;
                CELLS(after + 2 * path + z * stride + x) = l2;
                CELLS(total + z * picture + cell) = l0 + l1 + l2;
            }
            CELLS(after + PLANES * stride + x) = next0;
            CELLS(after + path + PLANES * stride + x) = next1;
            CELLS(after + 2 * path + PLANES * stride + x) = next2;
        }
        for (int i = 0; i < 3 * (PLANES + 1); i++)
            CELLS(after + i * (size_t)stride + width) = 0.0f;
    }
}

/* 8 rows of 8 cells with rows and columns exchanged. */
inline void transpose_block(float8 *v)
{
    float8 a[8], b[8];
    for (int i = 0; i < 8; i += 2) {
        a[i] = (float8)(v[i].s0, v[i + 1].s0, v[i].s1, v[i + 1].s1, v[i].s4, v[i + 1].s4, v[i].s5, v[i + 1].s5);
        a[i + 1] = (float8)(v[i].s2, v[i + 1].s2, v[i].s3, v[i + 1].s3, v[i].s6, v[i + 1].s6, v[i].s7, v[i + 1].s7);
    }
    for (int i = 0; i < 8; i += 4) {
        b[i] = (float8)(a[i].s01, a[i + 2].s01, a[i].s45, a[i + 2].s45);
        b[i + 1] = (float8)(a[i].s23, a[i + 2].s23, a[i].s67, a[i + 2].s67);
        b[i + 2] = (float8)(a[i + 1].s01, a[i + 3].s01, a[i + 1].s45, a[i + 3].s45);
        b[i + 3] = (float8)(a[i + 1].s23, a[i + 3].s23, a[i + 1].s67, a[i + 3].s67);
    }
    for (int i = 0; i < 4; i++) {
        v[i] = (float8)(b[i].lo, b[i + 4].lo);
        v[i + 4] = (float8)(b[i].hi, b[i + 4].hi);
    }
}

/* The paths along rows, both ways: total = their sum. A work-item takes 8 rows, whose cells it turns so that its lanes
 * are the rows. edges[3]: E to the cell at the left. Work-items (1, blocks of 8 rows). */
__kernel void follow_rows(__global const float *cost, __global const float *edges, __global const Noise *noise,
                          __global float *total, int width, int height, int stride)
{
    const int top = 8 * (int)get_global_id(1), rows = min(8, height - top);
    const size_t picture = (size_t)height * stride;
    const float p1 = 0.3f + 0.4f * noise->t, p2 = 2.0f;

    for (int backward = 0; backward < 2; backward++) {
        float8 path[PLANES], least = 0.0f, edge_after = 1.0f;
        for (int z = 0; z < PLANES; z++)
            path[z] = 0.0f;
        for (int block = 0; block < (width + 7) / 8; block++) {
            const int x = 8 * (backward ? (width + 7) / 8 - 1 - block : block);
            float8 cells[PLANES][8], edge[8];
            for (int j = 0; j < 8; j++)
                edge[j] = READ_CELLS(edges + 3 * picture + (size_t)(top + min(j, rows - 1)) * stride + SIDE + x);
            transpose_block(edge);
            for (int z = 0; z < PLANES; z++) {
                for (int j = 0; j < 8; j++)
                    cells[z][j] = READ_CELLS(cost + z * picture + (size_t)(top + min(j, rows - 1)) * stride + SIDE + x);
                transpose_block(cells[z]);
            }
            for (int i = 0; i < 8; i++) {
                const int column = backward ? 7 - i : i;
                const float8 e = backward ? edge_after : edge[column];
                edge_after = edge[column];
                float8 here = path[0], below = INFINITY, next_least = INFINITY;
                for (int z = 0; z < PLANES; z++) {
                    const float8 beyond = z + 1 < PLANES ? path[min(z + 1, PLANES - 1)] : (float8)(INFINITY);
                    const float8 value =
                        step_path(cells[z][column], beyond, p1 * e, least + p2 * e, least, &here, &below, &next_least);
                    path[z] = cells[z][column] = x + column < width ? value : 0.0f;
                }
                least = x + column < width ? next_least : 0.0f;
            }
            for (int z = 0; z < PLANES; z++) {
                transpose_block(cells[z]);
                for (int j = 0; j < rows; j++) {
                    __global float *sum = total + z * picture + (size_t)(top + j) * stride + SIDE + x;
                    CELLS(sum) = backward ? READ_CELLS(sum) + cells[z][j] : cells[z][j];
                }
            }
        }
    }
}

/* Each picture with rows and columns exchanged. Work-items (1, blocks of 8 rows, pictures). */
__kernel void transpose(__global const float *volume, __global float *transposed, int width, int height, int stride,
                        int transposed_stride)
{
    const int y = min(8 * (int)get_global_id(1), height - 8);
    __global const float *in = volume + (get_global_id(2) * height + y) * stride + SIDE;
    __global float *out = transposed + get_global_id(2) * width * transposed_stride + SIDE + y;
    for (int block = 0; block < width; block += 8) {
        const int x = min(block, width - 8);
        float8 cells[8];
        for (int j = 0; j < 8; j++)
            cells[j] = READ_CELLS(in + j * stride + x);
        transpose_block(cells);
        for (int i = 0; i < 8; i++)
            CELLS(out + (size_t)(x + i) * transposed_stride) = cells[i];
    }
}

/* u: the least of the three totals together, with a parabola through its neighbours; c = mean_z C.
 * Work-items (1, low height). */
__kernel void decide(__global const float *total_down, __global const float *total_up,
                     __global const float *total_along, __global const float *cost, __global float *u, __global float *confidence, int width, int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE, picture = get_global_size(1) * stride;
    for (int x = 0; x < width; x += 8) {
        float8 sums[PLANES], cost_sum = 0.0f, least = INFINITY, best = 0.0f;
        for (int z = 0; z < PLANES; z++) {
            const size_t cell = z * picture + row + x;
            sums[z] = READ_CELLS(total_down + cell) + READ_CELLS(total_up + cell) + READ_CELLS(total_along + cell);
            cost_sum += READ_CELLS(cost + cell);
            best = select(best, (float8)(z), sums[z] < least);
            least = min(least, sums[z]);
        }
        float8 position = best;
#if PLANES > 2
        float8 offset = 0.0f;
        for (int z = 1; z < PLANES - 1; z++) {
            const float8 curvature = sums[z - 1] - 2.0f * sums[z] + sums[z + 1];
            const float8 vertex = 0.5f * (sums[z - 1] - sums[z + 1]) / max(curvature, 1e-12f) + (z - best);
            offset = select(offset, vertex, clamp(best, 1.0f, PLANES - 2.0f) == (float8)(z) && curvature > 1e-12f);
        }
        position = clamp(best + clamp(offset, -0.5f, 0.5f), 0.0f, PLANES - 1.0f);
#endif
        CELLS(u + row + x) = position;
        CELLS(confidence + row + x) = clamp(cost_sum * (1.0f / PLANES), 0.0f, 1.0f);
    }
}
