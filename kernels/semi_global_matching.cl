/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Semi-global matching (Hirschmueller 2008) of a cost volume C over 8 paths, penalties damped where the guide changes:
 *
 *     L(p, z) = C(p, z) + min(L(q, z), L(q, z -+ 1) + P1 E(p, q), min_k L(q, k) + P2 E(p, q)) - min_k L(q, k)
 *     E(p, q) = exp(-|A(p) - A(q)|_1 / 15) + 0.01,  P1 = .3 + .4 t,  P2 = 2
 *
 * q is the cell before p on the path. A work-item follows 8 neighbouring paths down or up the picture; paths along
 * rows are columns of the transposed volume.
 */
#include "low_picture.cl"

#define FLOOR 0.01f

/* edges[0..2]: E to the cell above, above left, above right. The sides of the guide must be mirrored.
 * Work-items (1, low height). */
__kernel void edges_above(__global const float *guide, __global float *edges, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t picture = (size_t)height * stride, row = (size_t)y * stride + SIDE;
    const size_t above = (size_t)max(y - 1, 0) * stride + SIDE;
    for (int direction = 0; direction < 3; direction++) {
        const int dx = direction == 0 ? 0 : direction == 1 ? -1 : 1;
        for (int x = -8; x < width + 8; x += 8) {
            float8 difference = 0.0f;
            for (int colour = 0; colour < 3; colour++)
                difference += fabs(READ_CELLS(guide + colour * picture + row + x) -
                                   READ_CELLS(guide + colour * picture + above + x + dx));
            CELLS(edges + direction * picture + row + x) = native_exp(difference * (-1.0f / 15.0f)) + FLOOR;
        }
    }
}

/* Adds L of 8 paths that go by (dx, 1) a step, or (dx, -1) if `up`, to `total`, or starts it.
 * Work-items (1, blocks): each begins 8 columns after the one before, so that slanted paths from beside the picture
 * are among them. */
__kernel void follow(__global const float *cost, __global const float *edges, __global const Noise *noise,
                     __global float *total, int dx, int up, int start, int width, int height, int stride)
{
    const size_t picture = (size_t)height * stride;
    const int begin = 8 * (int)get_global_id(1) - (dx > 0 ? (height + 7) / 8 * 8 : 0);
    const int first = dx == 0 ? 0 : max(dx > 0 ? -7 - begin : begin - width + 1, 0);
    const int last = dx == 0 ? height : min(dx > 0 ? width - begin : begin + 8, height);
    /* E between p and q is kept at the lower of them. */
    __global const float *edge = edges + (dx == 0 ? 0 : (dx > 0) == (up == 0) ? 1 : 2) * picture + SIDE;
    const int8 lanes = (int8)(0, 1, 2, 3, 4, 5, 6, 7);
    const float p1 = 0.3f + 0.4f * noise->t, p2 = 2.0f;

    float8 path[PLANES];
    for (int z = 0; z < PLANES; z++)
        path[z] = 0.0f;
    float8 least = 0.0f;
    for (int step = first; step < last; step++) {
        const int y = up ? height - 1 - step : step, x = begin + dx * step;
        const size_t cell = (size_t)y * stride + SIDE + x;
        const float8 e = up ? READ_CELLS(edge + (size_t)min(y + 1, height - 1) * stride + x - dx)
                            : READ_CELLS(edge + (size_t)y * stride + x);
        const int8 inside = x + lanes >= 0 && x + lanes < width;
        const float8 small_step = p1 * e, jump = least + p2 * e;
        float8 below = INFINITY, here = path[0], next_least = INFINITY;
        for (int z = 0; z < PLANES; z++) {
            const float8 beyond = z + 1 < PLANES ? path[z + 1] : INFINITY;
            const float8 best = min(min(here, jump), min(below, beyond) + small_step);
            const float8 value = READ_CELLS(cost + z * picture + cell) + (best - least);
            const float8 kept = select((float8)(0.0f), value, inside);
            __global float *sum = total + z * picture + cell;
            CELLS(sum) = start ? kept : READ_CELLS(sum) + kept;
            path[z] = kept;
            next_least = min(next_least, kept);
            below = here;
            here = beyond;
        }
        least = next_least;
    }
}

/* Each picture of the volume with rows and columns exchanged. Work-items (1, blocks of 8 rows, pictures). */
__kernel void transpose(__global const float *volume, __global float *transposed, int width, int height, int stride,
                        int transposed_stride)
{
    const int y = min(8 * (int)get_global_id(1), height - 8);
    __global const float *in = volume + (get_global_id(2) * height + y) * stride + SIDE;
    __global float *out = transposed + get_global_id(2) * width * transposed_stride + SIDE + y;
    for (int block = 0; block < width; block += 8) {
        const int x = min(block, width - 8);
        const float8 a = READ_CELLS(in + x), b = READ_CELLS(in + stride + x), c = READ_CELLS(in + 2 * stride + x),
                     d = READ_CELLS(in + 3 * stride + x), e = READ_CELLS(in + 4 * stride + x),
                     f = READ_CELLS(in + 5 * stride + x), g = READ_CELLS(in + 6 * stride + x),
                     h = READ_CELLS(in + 7 * stride + x);
#define COLUMN(i) CELLS(out + (size_t)(x + i) * transposed_stride) = (float8)(a.s##i, b.s##i, c.s##i, d.s##i, e.s##i, f.s##i, g.s##i, h.s##i);
        COLUMN(0) COLUMN(1) COLUMN(2) COLUMN(3) COLUMN(4) COLUMN(5) COLUMN(6) COLUMN(7)
    }
}

/* u: the least of total + row_total with a parabola through its neighbours; c = mean_z C. Work-items (1, low height).
 */
__kernel void decide(__global const float *total, __global const float *row_total, __global const float *cost,
                     __global float *u, __global float *confidence, int width, int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE, picture = get_global_size(1) * stride;
    for (int x = 0; x < width; x += 8) {
        float8 sums[PLANES], cost_sum = 0.0f, least = INFINITY, best = 0.0f;
        for (int z = 0; z < PLANES; z++) {
            const size_t cell = z * picture + row + x;
            sums[z] = READ_CELLS(total + cell) + READ_CELLS(row_total + cell);
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
