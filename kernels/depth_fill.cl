/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Depth where the confidence c is low, from around: u <- a u + (1 - a) solved, a = min(1, c / its 90th percentile).
 *
 * solved = smooth(w u) / smooth(w), w = c^2 + 1e-4. smooth() is a fast global smoother (Min et al. 2014): for each
 * line the exact solution of x + lambda_i L x = f, L the Laplacian with the affinities exp(-|dA|_1 / 3), over columns
 * and rows in turn, twice with falling lambda_i.
 */
#include "low_picture.cl"

#define FLOOR 0.01f /* of the edges, see semi_global_matching.cl */

/* pair = (w u, w). Work-items (1, low height). */
__kernel void weigh(__global const float *u, __global const float *confidence, __global float *pair, int width,
                    int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE, picture = get_global_size(1) * stride;
    for (int x = 0; x < width; x += 8) {
        const float8 c = READ_CELLS(confidence + row + x), weight = c * c + 1e-4f;
        CELLS(pair + row + x) = weight * READ_CELLS(u + row + x);
        CELLS(pair + picture + row + x) = weight;
    }
}

/* Affinity to the cell above: exp(-|dA|_1 / 15) to the fifth. */
inline float8 affinity(__global const float *edges, size_t cell)
{
    const float8 e = READ_CELLS(edges + cell) - FLOOR, square = e * e;
    return square * square * e;
}

/* Solves the columns of both pictures of the pair in place (Thomas's algorithm). `direction` of the edges is along the
 * columns. Work-items (1, blocks of 8 columns); scratch: a picture. */
__kernel void smooth_columns(__global float *pair, __global const float *edges, int direction, __global float *scratch, float lambda,
                             int height, int stride)
{
    const size_t picture = (size_t)height * stride, first = SIDE + 8 * get_global_id(1);
    edges += direction * picture;
    float8 above = 0.0f, kept = 0.0f, u = 0.0f, weight = 0.0f;
    for (int y = 0; y < height; y++) {
        const size_t cell = first + (size_t)y * stride;
        const float8 below = y + 1 < height ? lambda * affinity(edges, cell + stride) : 0.0f;
        const float8 scale = 1.0f / (1.0f + above + below - above * kept);
        kept = below * scale;
        u = (READ_CELLS(pair + cell) + above * u) * scale;
        weight = (READ_CELLS(pair + picture + cell) + above * weight) * scale;
        CELLS(scratch + cell) = kept;
        CELLS(pair + cell) = u;
        CELLS(pair + picture + cell) = weight;
        above = below;
    }
    for (int y = height - 2; y >= 0; y--) {
        const size_t cell = first + (size_t)y * stride;
        kept = READ_CELLS(scratch + cell);
        u = READ_CELLS(pair + cell) + kept * u;
        weight = READ_CELLS(pair + picture + cell) + kept * weight;
        CELLS(pair + cell) = u;
        CELLS(pair + picture + cell) = weight;
    }
}

/* Work-items (1, low height). */
__kernel void fill(__global const float *pair, __global const float *confidence, __global const float *high_confidence,
                   __global float *u, int width, int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE, picture = get_global_size(1) * stride;
    const float scale = 1.0f / max(*high_confidence, 1e-6f);
    for (int x = 0; x < width; x += 8) {
        const float8 own = min(READ_CELLS(confidence + row + x) * scale, 1.0f);
        const float8 solved = READ_CELLS(pair + row + x) / READ_CELLS(pair + picture + row + x);
        CELLS(u + row + x) = own * READ_CELLS(u + row + x) + (1.0f - own) * solved;
    }
}
