/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Semi-global matching (Hirschmueller 2008) of a cost volume C over 8 paths, penalties damped where the guide changes:
 *
 *     L(p, z) = C(p, z) + min(L(q, z), L(q, z -+ 1) + P1 E(p, q), min_k L(q, k) + P2 E(p, q)) - min_k L(q, k)
 *     E(p, q) = exp(-|A(p) - A(q)|_1 / 15) + 0.01,  P1 = .4 + .4 t,  P2 = 2
 *
 * q is the cell before p on the path. Down and up go two work-items, row after row, each with three paths at once; along
 * rows go as many as there are blocks of 16 rows. C, E, L and their totals are shorts in 1/COST_ONE: C stays below 1.5,
 * hence L below 3.6 and the sum of 8 paths below 29 of the 32 that fit.
 */
#include "low_picture.cl"

#if PLANES <= 16
#define UNROLL_PLANES UNROLL
#else
#define UNROLL_PLANES /* would take long to compile */
#endif

#define FLOOR 0.01f
#define FAR 16000 /* above every L */

/* P1 and P2 times E, which `edge` holds; P1 in 1/64. */
#define SMALL_STEP(edge) as_short16(as_ushort16(edge) * p1 >> (ushort)6)
#define JUMP(edge) ((edge) + (edge))
#define P1_OF(noise) (ushort)(64.0f * (0.4f + 0.4f * noise->t) + 0.5f)

/* edges[0..3]: E to the cell above, above left, above right, left. The sides of the guide must be mirrored.
 * Work-items (1, low height). */
__kernel void find_edges(__global const float *guide, __global short *edges, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    const size_t above = (size_t)max(y - 1, 0) * stride + SIDE;
    const size_t others[4] = {above, above - 1, above + 1, row - 1};
    for (int x = -8; x < width + 8; x += 8)
        UNROLL
        for (int direction = 0; direction < 4; direction++) {
            float8 difference = 0.0f;
            UNROLL
            for (int colour = 0; colour < 3; colour++)
                difference += fabs(READ_CELLS(guide + colour * picture + row + x) -
                                   READ_CELLS(guide + colour * picture + others[direction] + x));
            HALF_SHORTS(edges + direction * picture + row + x) =
                to_shorts(COST_ONE * (quick_exp(difference * (-1.0f / 15.0f)) + FLOOR));
        }
}

/* L of one cell in the order of z: `here` and `below` are L(q, z) and L(q, z - 1) and move on. */
INLINE short16 step_path(short16 cost, short16 beyond, short16 small_step, short16 jump, short16 least, short16 *here,
                         short16 *below, short16 *next_least)
{
    const short16 value = cost + (min(min(*here, jump), min(*below, beyond) + small_step) - least);
    *below = *here;
    *here = beyond;
    *next_least = min(*next_least, value);
    return value;
}

/* The three paths that come from the row above, or from the one below: total = their sum. Work-items (1, 2): down, up.
 * scratch: for each of them L of the last row and of this, [2][3 paths][PLANES + 1: the last is min_k][stride]. A
 * path that enters the picture finds 0 before it, whereby L = C. */
__kernel void sweep_rows(__global const short *cost, __global const short *edges, __global const Noise *noise,
                         __global short *total_down, __global short *total_up, __global short *scratch, int width,
                         int height, int stride)
{
    const int up = (int)get_global_id(1);
    const size_t picture = (size_t)height * stride, path = (PLANES + 1) * (size_t)stride;
    __global short *total = up ? total_up : total_down;
    __global short *state = scratch + up * 6 * path;
    const ushort p1 = P1_OF(noise);
    for (size_t i = 0; i < 6 * path; i += 16)
        SHORTS(state + i) = 0;

    for (int step = 0; step < height; step++) {
        const int y = up ? height - 1 - step : step;
        __global const short *before = state + (step % 2) * 3 * path + SIDE;
        __global short *after = state + (1 - step % 2) * 3 * path + SIDE;
        /* E between p and q is kept at the lower of them; from below, the two slanted ones change places. */
        __global const short *edge = edges + (size_t)(up ? min(y + 1, height - 1) : y) * stride + SIDE;
        for (int x = 0; x < width; x += 16) {
            const size_t cell = (size_t)y * stride + SIDE + x;
            const short16 straight = READ_SHORTS(edge + x);
            const short16 left = up ? READ_SHORTS(edge + 2 * picture + x - 1) : READ_SHORTS(edge + picture + x);
            const short16 right = up ? READ_SHORTS(edge + picture + x + 1) : READ_SHORTS(edge + 2 * picture + x);
            __global const short *from0 = before + x, *from1 = before + path + x - 1, *from2 = before + 2 * path + x + 1;
            const short16 least0 = READ_SHORTS(from0 + PLANES * stride), least1 = READ_SHORTS(from1 + PLANES * stride),
                          least2 = READ_SHORTS(from2 + PLANES * stride);
            const short16 step0 = SMALL_STEP(straight), step1 = SMALL_STEP(left), step2 = SMALL_STEP(right);
            const short16 jump0 = least0 + JUMP(straight), jump1 = least1 + JUMP(left), jump2 = least2 + JUMP(right);
            short16 here0 = READ_SHORTS(from0), here1 = READ_SHORTS(from1), here2 = READ_SHORTS(from2);
            short16 below0 = FAR, below1 = FAR, below2 = FAR, next0 = FAR, next1 = FAR, next2 = FAR;
            UNROLL_PLANES
            for (int z = 0; z < PLANES; z++) {
                const int last = z + 1 == PLANES, next = last ? z : z + 1;
                const short16 value = READ_SHORTS(cost + z * picture + cell);
                const short16 beyond0 = last ? (short16)FAR : READ_SHORTS(from0 + next * stride);
                const short16 beyond1 = last ? (short16)FAR : READ_SHORTS(from1 + next * stride);
                const short16 beyond2 = last ? (short16)FAR : READ_SHORTS(from2 + next * stride);
                const short16 l0 = step_path(value, beyond0, step0, jump0, least0, &here0, &below0, &next0);
                const short16 l1 = step_path(value, beyond1, step1, jump1, least1, &here1, &below1, &next1);
                const short16 l2 = step_path(value, beyond2, step2, jump2, least2, &here2, &below2, &next2);
                SHORTS(after + z * stride + x) = l0;
                SHORTS(after + path + z * stride + x) = l1;
                SHORTS(after + 2 * path + z * stride + x) = l2;
                SHORTS(total + z * picture + cell) = l0 + l1 + l2;
            }
            SHORTS(after + PLANES * stride + x) = next0;
            SHORTS(after + path + PLANES * stride + x) = next1;
            SHORTS(after + 2 * path + PLANES * stride + x) = next2;
        }
        for (int i = 0; i < 3 * (PLANES + 1); i++)
            HALF_SHORTS(after + i * (size_t)stride + width) = 0;
    }
}

/* The interleaved lower and upper halves of each 128 bits of a and b, by words of 16, 32 and 64 bits. */
#define LOW_16(a, b)                                                                                                   \
    (short16)(a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3, a.s8, b.s8, a.s9, b.s9, a.sa, b.sa, a.sb, b.sb)
#define HIGH_16(a, b)                                                                                                  \
    (short16)(a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7, b.s7, a.sc, b.sc, a.sd, b.sd, a.se, b.se, a.sf, b.sf)
#define LOW_32(a, b) (int8)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5)
#define HIGH_32(a, b) (int8)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7)
#define LOW_64(a, b) (long4)(a.s0, b.s0, a.s2, b.s2)
#define HIGH_64(a, b) (long4)(a.s1, b.s1, a.s3, b.s3)

/* 8 rows of two squares of 8x8, side by side, each with rows and columns exchanged. */
INLINE void transpose_squares(short16 *v)
{
    int8 a[8];
    long4 b[8];
    UNROLL
    for (int i = 0; i < 4; i++) {
        a[2 * i] = as_int8(LOW_16(v[2 * i], v[2 * i + 1]));
        a[2 * i + 1] = as_int8(HIGH_16(v[2 * i], v[2 * i + 1]));
    }
    UNROLL
    for (int i = 0; i < 8; i += 4)
        UNROLL
        for (int j = 0; j < 2; j++) {
            b[i + 2 * j] = as_long4(LOW_32(a[i + j], a[i + j + 2]));
            b[i + 2 * j + 1] = as_long4(HIGH_32(a[i + j], a[i + j + 2]));
        }
    UNROLL
    for (int i = 0; i < 4; i++) {
        v[2 * i] = as_short16(LOW_64(b[i], b[i + 4]));
        v[2 * i + 1] = as_short16(HIGH_64(b[i], b[i + 4]));
    }
}

/* 16 rows of 16 cells with rows and columns exchanged. */
INLINE void transpose_block(short16 *v)
{
    transpose_squares(v);
    transpose_squares(v + 8);
    UNROLL
    for (int i = 0; i < 8; i++) {
        const short16 upper = v[i], lower = v[i + 8];
        v[i] = (short16)(upper.lo, lower.lo);
        v[i + 8] = (short16)(upper.hi, lower.hi);
    }
}

INLINE void read_block(__global const short *cells, short16 *block, int rows, int stride)
{
    UNROLL
    for (int j = 0; j < 16; j++)
        block[j] = READ_SHORTS(cells + (size_t)min(j, rows - 1) * stride);
    transpose_block(block);
}

/* The paths along rows, both ways: total = their sum. A work-item takes 16 rows, whose cells it turns so that its lanes
 * are the rows. edges[3]: E to the cell at the left. Work-items (1, blocks of 16 rows). */
__kernel void follow_rows(__global const short *cost, __global const short *edges, __global const Noise *noise,
                          __global short *total, int width, int height, int stride)
{
    const int top = 16 * (int)get_global_id(1), rows = min(16, height - top), blocks = (width + 15) / 16;
    const size_t picture = (size_t)height * stride, corner = (size_t)top * stride + SIDE;
    const ushort p1 = P1_OF(noise);

    for (int backward = 0; backward < 2; backward++) {
        short16 path[PLANES], least = 0, edge_after = COST_ONE;
        UNROLL_PLANES
        for (int z = 0; z < PLANES; z++)
            path[z] = 0;
        for (int block = 0; block < blocks; block++) {
            const int x = 16 * (backward ? blocks - 1 - block : block);
            short16 cells[PLANES][16], edge[16];
            read_block(edges + 3 * picture + corner + x, edge, rows, stride);
            for (int z = 0; z < PLANES; z++)
                read_block(cost + z * picture + corner + x, cells[z], rows, stride);
            for (int i = 0; i < 16; i++) {
                const int column = backward ? 15 - i : i;
                const short16 e = backward ? edge_after : edge[column];
                const short16 small_step = SMALL_STEP(e), jump = least + JUMP(e);
                edge_after = edge[column];
                short16 here = path[0], below = FAR, next_least = FAR;
                const int is_inside = x + column < width;
                UNROLL_PLANES
                for (int z = 0; z < PLANES; z++) {
                    const short16 beyond = z + 1 < PLANES ? path[min(z + 1, PLANES - 1)] : (short16)FAR;
                    const short16 value =
                        step_path(cells[z][column], beyond, small_step, jump, least, &here, &below, &next_least);
                    path[z] = cells[z][column] = is_inside ? value : (short16)0;
                }
                least = is_inside ? next_least : (short16)0;
            }
            for (int z = 0; z < PLANES; z++) {
                transpose_block(cells[z]);
                for (int j = 0; j < rows; j++) {
                    __global short *sum = total + z * picture + corner + (size_t)j * stride + x;
                    SHORTS(sum) = backward ? READ_SHORTS(sum) + cells[z][j] : cells[z][j];
                }
            }
        }
    }
}

/* u: the least of the three totals together, and where between the planes: with v the vertex of a parabola through its
 * neighbours, v (1 + k) / (1 + 2 k |v|), k = 2 - 1.4 t, since the totals come to a point rather than to a parabola's foot
 * (two straight lines would be k = 1) and v lies too near to the plane. c = mean_z C. The ends of both are mirrored.
 * Work-items (1, low height). */
__kernel void decide(__global const short *total_down, __global const short *total_up,
                     __global const short *total_along, __global const short *cost, __global float *u,
                     __global float *confidence, __global const Noise *noise, int width, int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE, picture = get_global_size(1) * stride;
    const float pointedness = 2.0f - 1.4f * noise->t;
    for (int x = 0; x < width; x += 8) {
        short8 sums[PLANES], cost_sum = 0, least = SHRT_MAX, best = 0;
        UNROLL_PLANES
        for (int z = 0; z < PLANES; z++) {
            const size_t cell = z * picture + row + x;
            sums[z] = READ_HALF_SHORTS(total_down + cell) + READ_HALF_SHORTS(total_up + cell) +
                      READ_HALF_SHORTS(total_along + cell);
            cost_sum += READ_HALF_SHORTS(cost + cell) >> (short)2; /* of 64 planes, too, it fits */
            best = select(best, (short8)(short)z, sums[z] < least);
            least = min(least, sums[z]);
        }
        float8 position = convert_float8(best);
#if PLANES > 2
        const short8 middle = clamp(best, (short8)1, (short8)(PLANES - 2));
        short8 before = 0, here = 0, after = 0;
        UNROLL_PLANES
        for (int z = 1; z < PLANES - 1; z++) {
            before = select(before, sums[z - 1], middle == (short8)(short)z);
            here = select(here, sums[z], middle == (short8)(short)z);
            after = select(after, sums[z + 1], middle == (short8)(short)z);
        }
        const float8 slope = convert_float8(convert_int8(before) - convert_int8(after));
        const float8 curvature =
            convert_float8(convert_int8(before) - 2 * convert_int8(here) + convert_int8(after));
        const float8 vertex = curvature > 0.0f ? 0.5f * slope / max(curvature, 1.0f) + convert_float8(middle - best)
                                               : (float8)0.0f;
        const float8 offset = clamp(vertex, -0.5f, 0.5f);
        const float8 between = offset * (1.0f + pointedness) / (1.0f + 2.0f * pointedness * fabs(offset));
        position = clamp(position + between, 0.0f, PLANES - 1.0f);
#endif
        CELLS(u + row + x) = position;
        CELLS(confidence + row + x) = clamp(convert_float8(cost_sum) * (4.0f / COST_ONE / PLANES), 0.0f, 1.0f);
    }
    mirror_ends(u + row, width);
    mirror_ends(confidence + row, width);
}
