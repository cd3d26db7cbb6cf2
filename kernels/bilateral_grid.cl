/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The smoothness problem (4)-(8) of Oliva-García 2022, solved in bilateral space (Barron and Poole 2016).
 *
 * Pixels with similar place and colour share a cell of a dense grid: [rows + 2][columns + 2][V + 2][U + 2][Y + 2], with
 * a border of empty cells so that neighbours need no tests (U and V are there only with DIMENSIONS = 5). Strides, in
 * cells, come as int4 (row, column, V, U); Y has the stride 1. Vectors are float[cells]; kernels over cells run over
 * the rows within the border and are given the first of these cells.
 *
 *     B   blur: 10 times a cell and once each neighbour along each axis
 *     n   bistochastisation: n <- sqrt(n m / (B n)), m the pixels a cell holds; an empty cell has n = 0
 *     A = lambda (diag(n B n) - diag(n) B diag(n)) + diag(w + EPSILON),  A y = b + EPSILON t0
 *     w   known pixels a cell holds, b the sum of their planes, t0 their mean plane
 */
#define CENTRE_WEIGHT 10.0f
#define EPSILON 1e-6f

inline float neighbours(__global const float *v, int i, int4 stride)
{
    float sum = v[i - 1] + v[i + 1] + v[i - stride.s0] + v[i + stride.s0] + v[i - stride.s1] + v[i + stride.s1];
#if DIMENSIONS == 5
    sum += v[i - stride.s2] + v[i + stride.s2] + v[i - stride.s3] + v[i + stride.s3];
#endif
    return sum;
}

inline float neighbours_product(__global const float *n, __global const float *v, int i, int4 stride)
{
    float sum = n[i - 1] * v[i - 1] + n[i + 1] * v[i + 1] + n[i - stride.s0] * v[i - stride.s0] +
                n[i + stride.s0] * v[i + stride.s0] + n[i - stride.s1] * v[i - stride.s1] +
                n[i + stride.s1] * v[i + stride.s1];
#if DIMENSIONS == 5
    sum += n[i - stride.s2] * v[i - stride.s2] + n[i + stride.s2] * v[i + stride.s2] +
           n[i - stride.s3] * v[i - stride.s3] + n[i + stride.s3] * v[i + stride.s3];
#endif
    return sum;
}

/* Cell of a pixel. sigma = (xy, luma, chroma). */
inline int cell_of(int x, int y, ulong pixel, __global const uchar *reference_y, __global const uchar *reference_u,
                   __global const uchar *reference_v, int4 stride, int4 sigma)
{
    int cell = (y / sigma.s0 + 1) * stride.s0 + (x / sigma.s0 + 1) * stride.s1 + reference_y[pixel] / sigma.s1 + 1;
#if DIMENSIONS == 5
    cell += (reference_v[pixel] / sigma.s2 + 1) * stride.s2 + (reference_u[pixel] / sigma.s2 + 1) * stride.s3;
#endif
    return cell;
}

/* Sums the pixels into the cells: one work-item a column of the grid, so that nothing is written by two. */
__kernel void splat(__global const uchar *sparse, __global const uchar *reference_y, __global const uchar *reference_u,
                    __global const uchar *reference_v, __global float *mass, __global float *weight,
                    __global float *target, int width, int height, int columns, int4 stride, int4 sigma)
{
    const int column = (int)get_global_id(0), row = (int)get_global_id(1);
    if (column >= columns)
        return;
    const int end_x = min((column + 1) * sigma.s0, width), end_y = min((row + 1) * sigma.s0, height);
    for (int y = row * sigma.s0; y < end_y; y++)
        for (int x = column * sigma.s0; x < end_x; x++) {
            const ulong pixel = (ulong)y * width + x;
            const int cell = cell_of(x, y, pixel, reference_y, reference_u, reference_v, stride, sigma);
            mass[cell] += 1.0f;
            if (sparse[pixel] != UNKNOWN_PLANE) {
                weight[cell] += 1.0f;
                target[cell] += 0.5f * sparse[pixel];
            }
        }
}

__kernel void start_normalisation(__global const float *mass, __global float *n, int first, int cells)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    n[i] = mass[i] > 0.0f ? 1.0f : 0.0f;
}

/* One step of bistochastisation, n -> next. */
__kernel void normalise(__global const float *mass, __global const float *n, __global float *next, int first, int cells,
                        int4 stride)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    const float blurred = CENTRE_WEIGHT * n[i] + neighbours(n, i, stride);
    next[i] = mass[i] > 0.0f ? sqrt(n[i] * mass[i] / blurred) : 0.0f;
}

/* smooth = n B n: the diagonal of the smoothness term before B is taken away. */
__kernel void smoothness(__global const float *n, __global float *smooth, int first, int cells, int4 stride)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    smooth[i] = n[i] * (CENTRE_WEIGHT * n[i] + neighbours(n, i, stride));
}

/* PARTS partial sums of a * b, or of a alone. */
#define PARTS 256

__kernel void partial_sums(__global const float *a, __global float *parts, int first, int cells)
{
    const int part = (int)get_global_id(0);
    float sum = 0.0f;
    for (int i = part; i < cells; i += PARTS)
        sum += a[first + i];
    parts[part] = sum;
}

__kernel void partial_products(__global const float *a, __global const float *b, __global float *parts, int first,
                               int cells)
{
    const int part = (int)get_global_id(0);
    float sum = 0.0f;
    for (int i = part; i < cells; i += PARTS)
        sum += a[first + i] * b[first + i];
    parts[part] = sum;
}

inline float total(__global const float *parts)
{
    float sum = 0.0f;
    for (int i = 0; i < PARTS; i++)
        sum += parts[i];
    return sum;
}

/* The numbers of the conjugate gradient that live on the device. */
typedef struct {
    float mean_target;   /* t0; NAN if nothing is known at all */
    float residual;      /* r . (r / diagonal) */
    float alpha;
    float beta;
} Scalars;

/* One work-item: t0 = sum b / sum w. */
__kernel void mean_target(__global const float *target_parts, __global const float *weight_parts,
                          __global Scalars *scalars)
{
    const float weight = total(weight_parts);
    scalars->mean_target = weight > 0.0f ? total(target_parts) / weight : NAN;
}

/* Starts from each cell's own mean plane, or t0 where nothing is known; Jacobi preconditioner. */
__kernel void start_solution(__global const float *n, __global const float *smooth, __global const float *weight,
                             __global const float *target, __global const Scalars *scalars, __global float *solution,
                             __global float *diagonal, int first, int cells, float lambda)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    solution[i] = weight[i] > 0.0f ? target[i] / weight[i] : scalars->mean_target;
    diagonal[i] = fmax(lambda * (smooth[i] - CENTRE_WEIGHT * n[i] * n[i]) + weight[i] + EPSILON, 1e-5f);
}

/* (A v)_i */
inline float system_at(__global const float *n, __global const float *smooth, __global const float *weight,
                       __global const float *v, int i, int4 stride, float lambda)
{
    const float blurred = n[i] * (CENTRE_WEIGHT * n[i] * v[i] + neighbours_product(n, v, i, stride));
    return lambda * (smooth[i] * v[i] - blurred) + (weight[i] + EPSILON) * v[i];
}

/* residual = b + EPSILON t0 - A y; direction = residual / diagonal. */
__kernel void start_residual(__global const float *n, __global const float *smooth, __global const float *weight,
                             __global const float *target, __global const Scalars *scalars,
                             __global const float *solution, __global const float *diagonal, __global float *residual,
                             __global float *scaled, __global float *direction, int first, int cells, int4 stride,
                             float lambda)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    const float product = system_at(n, smooth, weight, solution, i, stride, lambda);
    residual[i] = target[i] + EPSILON * scalars->mean_target - product;
    scaled[i] = residual[i] / diagonal[i];
    direction[i] = scaled[i];
}

__kernel void apply_system(__global const float *n, __global const float *smooth, __global const float *weight,
                           __global const float *direction, __global float *product, int first, int cells, int4 stride,
                           float lambda)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    product[i] = system_at(n, smooth, weight, direction, i, stride, lambda);
}

/* One work-item: takes r . (r / diagonal) after the start. */
__kernel void first_residual(__global const float *parts, __global Scalars *scalars)
{
    scalars->residual = total(parts);
}

/* One work-item: alpha = residual / (p . A p); 0 when the solution is exact already. */
__kernel void step_length(__global const float *parts, __global Scalars *scalars)
{
    const float curvature = total(parts);
    scalars->alpha = curvature > 0.0f ? scalars->residual / curvature : 0.0f;
}

/* One work-item: beta = new residual / old residual. */
__kernel void next_residual(__global const float *parts, __global Scalars *scalars)
{
    const float residual = total(parts);
    scalars->beta = scalars->residual > 0.0f ? residual / scalars->residual : 0.0f;
    scalars->residual = residual;
}

__kernel void advance(__global const Scalars *scalars, __global const float *direction, __global const float *product,
                   __global const float *diagonal, __global float *solution, __global float *residual,
                   __global float *scaled, int first, int cells)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    solution[i] += scalars->alpha * direction[i];
    residual[i] -= scalars->alpha * product[i];
    scaled[i] = residual[i] / diagonal[i];
}

__kernel void next_direction(__global const Scalars *scalars, __global const float *scaled, __global float *direction,
                             int first, int cells)
{
    const int i = (int)get_global_id(0) + first;
    if (i >= first + cells)
        return;
    direction[i] = scaled[i] + scalars->beta * direction[i];
}

/* u[height][width]: the solution in each pixel's cell. */
__kernel void slice(__global const float *solution, __global const uchar *reference_y,
                    __global const uchar *reference_u, __global const uchar *reference_v, __global float *u, int width,
                    int4 stride, int4 sigma)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    const ulong pixel = (ulong)y * width + x;
    u[pixel] = solution[cell_of(x, y, pixel, reference_y, reference_u, reference_v, stride, sigma)];
}
