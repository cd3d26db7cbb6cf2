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

/* Affinity to the cell above or at the left: exp(-|dA|_1 / 15) to the fifth. */
INLINE float8 affinity(short8 edge)
{
    const float8 e = max(convert_float8(edge) * (1.0f / COST_ONE) - FLOOR, 0.0f), square = e * e;
    return square * square * e;
}

/* What Thomas's algorithm carries from cell to cell, for the two pictures of the pair. */
typedef struct {
    float8 before, kept, u, weight;
} Line;

/* One step of the elimination; `after`: lambda times the affinity to the next cell. */
INLINE void eliminate(Line *line, float8 u, float8 weight, float8 after)
{
    const float8 scale = 1.0f / (1.0f + line->before + after - line->before * line->kept);
    line->kept = after * scale;
    line->u = (u + line->before * line->u) * scale;
    line->weight = (weight + line->before * line->weight) * scale;
    line->before = after;
}

/* Solves the columns of both pictures of the pair in place, in blocks of 16 columns. edges[0]: E to the cell above.
 * Work-items (1, blocks); scratch: a picture. */
__kernel void smooth_columns(__global float *pair, __global const short *edges, __global float *scratch, float lambda,
                             int height, int stride)
{
    const size_t picture = (size_t)height * stride, first = SIDE + 16 * get_global_id(1);
    Line lines[2];
    UNROLL
    for (int i = 0; i < 2; i++)
        lines[i] = (Line){0.0f, 0.0f, 0.0f, 0.0f};
    for (int y = 0; y < height; y++)
        UNROLL
        for (int i = 0; i < 2; i++) {
            const size_t cell = first + (size_t)y * stride + 8 * i;
            const float8 below = y + 1 < height ? lambda * affinity(READ_HALF_SHORTS(edges + cell + stride)) : 0.0f;
            eliminate(&lines[i], READ_CELLS(pair + cell), READ_CELLS(pair + picture + cell), below);
            CELLS(scratch + cell) = lines[i].kept;
            CELLS(pair + cell) = lines[i].u;
            CELLS(pair + picture + cell) = lines[i].weight;
        }
    for (int y = height - 2; y >= 0; y--)
        UNROLL
        for (int i = 0; i < 2; i++) {
            const size_t cell = first + (size_t)y * stride + 8 * i;
            const float8 kept = READ_CELLS(scratch + cell);
            CELLS(pair + cell) = lines[i].u = READ_CELLS(pair + cell) + kept * lines[i].u;
            CELLS(pair + picture + cell) = lines[i].weight = READ_CELLS(pair + picture + cell) + kept * lines[i].weight;
        }
}

/* 8 rows of 8 cells with rows and columns exchanged. */
INLINE void transpose_block(float8 *v)
{
    float8 a[8], b[8];
    UNROLL
    for (int i = 0; i < 8; i += 2) {
        a[i] = (float8)(v[i].s0, v[i + 1].s0, v[i].s1, v[i + 1].s1, v[i].s4, v[i + 1].s4, v[i].s5, v[i + 1].s5);
        a[i + 1] = (float8)(v[i].s2, v[i + 1].s2, v[i].s3, v[i + 1].s3, v[i].s6, v[i + 1].s6, v[i].s7, v[i + 1].s7);
    }
    UNROLL
    for (int i = 0; i < 8; i += 4) {
        b[i] = (float8)(a[i].s01, a[i + 2].s01, a[i].s45, a[i + 2].s45);
        b[i + 1] = (float8)(a[i].s23, a[i + 2].s23, a[i].s67, a[i + 2].s67);
        b[i + 2] = (float8)(a[i + 1].s01, a[i + 3].s01, a[i + 1].s45, a[i + 3].s45);
        b[i + 3] = (float8)(a[i + 1].s23, a[i + 3].s23, a[i + 1].s67, a[i + 3].s67);
    }
    UNROLL
    for (int i = 0; i < 4; i++) {
        v[i] = (float8)(b[i].lo, b[i + 4].lo);
        v[i + 4] = (float8)(b[i].hi, b[i + 4].hi);
    }
}

INLINE void read_block(__global const float *cells, float8 *block, int rows, int stride)
{
    UNROLL
    for (int j = 0; j < 8; j++)
        block[j] = READ_CELLS(cells + (size_t)min(j, rows - 1) * stride);
    transpose_block(block);
}

INLINE void write_block(__global float *cells, float8 *block, int rows, int stride)
{
    transpose_block(block);
    for (int j = 0; j < rows; j++)
        CELLS(cells + (size_t)j * stride) = block[j];
}

/* Solves the rows likewise, in blocks of 8 rows, whose cells it turns so that its lanes are the rows. edges[3]: E to the
 * cell at the left. */
__kernel void smooth_rows(__global float *pair, __global const short *edges, __global float *scratch, float lambda,
                          int width, int height, int stride)
{
    const int top = 8 * (int)get_global_id(1), rows = min(8, height - top);
    const size_t picture = (size_t)height * stride, corner = (size_t)top * stride + SIDE;
    Line line = {0.0f, 0.0f, 0.0f, 0.0f};
    for (int x = 0; x < width; x += 8) {
        float8 u[8], weight[8], after[8], kept[8];
        UNROLL
        for (int j = 0; j < 8; j++)
            after[j] = lambda * affinity(READ_HALF_SHORTS(edges + 3 * picture + corner + (size_t)min(j, rows - 1) * stride + x + 1));
        transpose_block(after);
        read_block(pair + corner + x, u, rows, stride);
        read_block(pair + picture + corner + x, weight, rows, stride);
        UNROLL
        for (int i = 0; i < 8; i++) {
            eliminate(&line, u[i], weight[i], x + i + 1 < width ? after[i] : 0.0f);
            kept[i] = line.kept;
            u[i] = line.u;
            weight[i] = line.weight;
        }
        write_block(scratch + corner + x, kept, rows, stride);
        write_block(pair + corner + x, u, rows, stride);
        write_block(pair + picture + corner + x, weight, rows, stride);
    }
    for (int x = (width - 1) / 8 * 8; x >= 0; x -= 8) {
        float8 u[8], weight[8], kept[8];
        read_block(scratch + corner + x, kept, rows, stride);
        read_block(pair + corner + x, u, rows, stride);
        read_block(pair + picture + corner + x, weight, rows, stride);
        UNROLL
        for (int i = 7; i >= 0; i--) {
            if (x + i >= width - 1) {
                line.u = u[i];
                line.weight = weight[i];
                continue;
            }
            u[i] = line.u = u[i] + kept[i] * line.u;
            weight[i] = line.weight = weight[i] + kept[i] * line.weight;
        }
        write_block(pair + corner + x, u, rows, stride);
        write_block(pair + picture + corner + x, weight, rows, stride);
    }
}

/* The sides of u are mirrored. Work-items (1, low height). */
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
    mirror_ends(u + row, width);
}
