/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The smoothness problem of bilateral_grid.cl in the dense 3-D grid (x, y, luma), for CPUs: 16 cells at once, one
 * work-item a row of the grid.
 *
 * Cells are float[rows + 2][ROW]; a row is [columns + 2][COLUMN] and some padding, a column an empty cell and one for
 * each step of luma. Border, padding and empty cells are 0 in every vector. COLUMN, ROW, COLUMNS, ROWS, SIGMA_XY and
 * SIGMA_LUMA are built in.
 *
 * The unknowns are scaled by the diagonal of A, x = sqrt(D) y, so that one coefficient a cell holds the whole system:
 *
 *     D_i = lambda n_i sum_j n_j + w_i + EPSILON,  d = 1 / sqrt(D),  e = sqrt(lambda) n d,  j the neighbours of i
 *     (A' x)_i = x_i - e_i sum_j e_j x_j = d_i (target_i + EPSILON t0)
 *
 * and the conjugate gradient needs no preconditioner: it takes the steps that Jacobi's would. Its two dot products a
 * step are taken together (Chronopoulos and Gear 1989), which leaves two kernels a step.
 */
#include "lanes32.cl"
#include "grid_area.cl"

#define CENTRE_WEIGHT 10.0f
#define EPSILON 1e-6f

typedef __global float *Cells;
typedef __global const float *ConstCells;

INLINE float16 at(ConstCells v, int i)
{
    return *(__global const flanes *)(v + i);
}

INLINE void put(Cells v, int i, float16 value)
{
    *(__global flanes *)(v + i) = value;
}

INLINE float16 neighbours(ConstCells v, int i)
{
    return at(v, i - 1) + at(v, i + 1) + at(v, i - COLUMN) + at(v, i + COLUMN) + at(v, i - ROW) + at(v, i + ROW);
}

/* (A' x)_i */
INLINE float16 system_at(ConstCells e, ConstCells x, int i)
{
    const float16 sum = at(e, i - 1) * at(x, i - 1) + at(e, i + 1) * at(x, i + 1) +
                        at(e, i - COLUMN) * at(x, i - COLUMN) + at(e, i + COLUMN) * at(x, i + COLUMN) +
                        at(e, i - ROW) * at(x, i - ROW) + at(e, i + ROW) * at(x, i + ROW);
    return at(x, i) - at(e, i) * sum;
}

/* Sum over the grid of what each row gives; behind the rows stands 0 up to a whole vector. */
INLINE float2 sum_of_rows(__global const float2 *row_sums)
{
    float16 sums = 0.0f;
    for (int i = 0; i < ROWS; i += 8)
        sums += *(__global const flanes *)(row_sums + i);
    const float8 a = sums.lo + sums.hi;
    const float4 b = a.lo + a.hi;
    return b.lo + b.hi;
}

INLINE float sum_of_norms(__global const float *row_norms)
{
    float16 sums = 0.0f;
    for (int i = 0; i < ROWS; i += 16)
        sums += at(row_norms, i);
    return sum_of_lanes(sums);
}

/* First cell of the work-item's row. */
INLINE int first_cell(void)
{
    return ((int)get_group_id(0) + 1) * ROW;
}

/* mass: pixels a cell holds; weight, target: known ones, sum of their planes; n: 1 where there are any. The last lanes
 * of a column may be the next one's, which writes them later, or padding.
 * row_sums: (target, weight) of the row. */
__kernel void splat_rows(__global const uchar *sparse, __global const uchar *luma, Cells mass, Cells weight,
                         Cells target, Cells n, __global float2 *row_sums, int width, int height)
{
    const int top = (int)get_group_id(0) * SIGMA_XY;
    uint16 targets = 0, weights = 0;
    int cell = first_cell() + COLUMN + 1;
    for (int left = 0; left < width; left += SIGMA_XY, cell += COLUMN) {
        Area area;
        load_area(sparse, luma, left, top, width, height, &area);
        for (int step = 0; step < COLUMN - 1; step += 16) {
            uint16 pixels = 0, known = 0, places = 0;
            for (int i = max(area.first, step); i <= min(area.last, step + 15); i++) {
                const uint3 count = count_step(&area, (uchar)i);
                const int16 here = LANE == i - step;
                pixels = here ? (uint16)count.x : pixels;
                known = here ? (uint16)count.y : known;
                places = here ? (uint16)count.z : places;
            }
            put(mass, cell + step, convert_float16(pixels));
            put(weight, cell + step, convert_float16(known));
            put(target, cell + step, 0.5f * convert_float16(places));
            put(n, cell + step, pixels > 0u ? (float16)1.0f : (float16)0.0f);
            weights += known;
            targets += places;
        }
    }
    row_sums[get_group_id(0)] =
        (float2)(0.5f * sum_of_lanes(convert_float16(targets)), sum_of_lanes(convert_float16(weights)));
}

/* 1 / sqrt(v) of v > 0 by three of Newton's steps, a third of what a root and a division take. */
INLINE float16 inverse_root(float16 v)
{
    float16 root = as_float16(0x5f3759df - (as_int16(v) >> 1));
    __attribute__((opencl_unroll_hint))
    for (int i = 0; i < 3; i++)
        root *= 1.5f - 0.5f * v * root * root;
    return root;
}

/* One step of bistochastisation, n -> next = sqrt(n mass / (blurred n)). */
__kernel void normalise_rows(ConstCells mass, ConstCells n, Cells next)
{
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        const float16 m = at(mass, i), here = at(n, i);
        const float16 blurred = CENTRE_WEIGHT * here + neighbours(n, i), product = here * m;
        put(next, i, m > 0.0f ? product * inverse_root(product * blurred) : 0.0f);
    }
}

/* The system: coefficients e, scale d, right-hand side. row_norms: its squared norm in the row. */
__kernel void scale_rows(ConstCells n, ConstCells weight, ConstCells target, __global const float2 *row_sums, Cells e,
                         Cells d, Cells right, __global float *row_norms, float lambda)
{
    const float2 sums = sum_of_rows(row_sums);
    const float mean_target = sums.x / sums.y;
    float16 norm = 0.0f;
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        const float16 here = at(n, i);
        const int16 occupied = here > 0.0f;
        const float16 scale = inverse_root(lambda * here * neighbours(n, i) + at(weight, i) + EPSILON);
        const float16 r = occupied ? (at(target, i) + EPSILON * mean_target) * scale : 0.0f;
        put(e, i, sqrt(lambda) * here * scale);
        put(d, i, occupied ? scale : 0.0f);
        put(right, i, r);
        norm += r * r;
    }
    row_norms[get_group_id(0)] = sum_of_lanes(norm);
}

/* A first guess: target and weight spread by recursive filters along luma and x (here) and y (spread_columns). */
#define KEEP_XY 0.6f
#define KEEP_LUMA 0.4f

INLINE void spread_cells(ConstCells from, Cells to, int first)
{
    for (int step = 0; step < COLUMN - 1; step += 16) {
        const int16 inside = LANE < COLUMN - 1 - step; /* the others are the next column's */
        float16 kept = 0.0f;
        for (int column = 1; column <= COLUMNS; column++) {
            const int i = first + column * COLUMN + 1 + step;
            kept = at(from, i) + KEEP_LUMA * (at(from, i - 1) + at(from, i + 1)) + KEEP_XY * kept;
            put(to, i, inside ? kept : at(to, i));
        }
        for (int column = COLUMNS - 1; column >= 1; column--) {
            const int i = first + column * COLUMN + 1 + step;
            kept = at(to, i) + KEEP_XY * kept;
            put(to, i, inside ? kept : at(to, i));
        }
    }
}

__kernel void spread_rows(ConstCells target, ConstCells weight, Cells spread_target, Cells spread_weight)
{
    spread_cells(target, spread_target, first_cell());
    spread_cells(weight, spread_weight, first_cell());
}

/* One work-item 16 cells of all rows. */
__kernel void spread_columns(Cells spread_target, Cells spread_weight)
{
    const int first = (int)get_group_id(0) * 16;
    for (int row = 2; row <= ROWS; row++) {
        const int i = row * ROW + first;
        put(spread_target, i, at(spread_target, i) + KEEP_XY * at(spread_target, i - ROW));
        put(spread_weight, i, at(spread_weight, i) + KEEP_XY * at(spread_weight, i - ROW));
    }
    for (int row = ROWS - 1; row >= 1; row--) {
        const int i = row * ROW + first;
        put(spread_target, i, at(spread_target, i) + KEEP_XY * at(spread_target, i + ROW));
        put(spread_weight, i, at(spread_weight, i) + KEEP_XY * at(spread_weight, i + ROW));
    }
}

/* The two starts, scaled: the spread means, and the last stack's solution where its cells were occupied. */
__kernel void start_rows(ConstCells spread_target, ConstCells spread_weight, __global const float2 *row_sums,
                         ConstCells last, ConstCells d, Cells spread_start, Cells last_start)
{
    const float2 sums = sum_of_rows(row_sums);
    const float mean_target = sums.x / sums.y;
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        const float16 weight = at(spread_weight, i), scale = at(d, i), before = at(last, i);
        const float16 mean = weight > 1e-12f ? at(spread_target, i) / weight : mean_target;
        const int16 occupied = scale > 0.0f;
        put(spread_start, i, occupied ? mean / scale : 0.0f);
        put(last_start, i, occupied ? (before > 0.0f ? before : mean) / scale : 0.0f);
    }
}

/* Residuals of both starts; row_norms: their squared norms in the row. */
__kernel void start_residuals(ConstCells e, ConstCells right, ConstCells spread_start, ConstCells last_start,
                              Cells spread_residual, Cells last_residual, __global float2 *row_norms)
{
    float16 spread_norm = 0.0f, last_norm = 0.0f;
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        const float16 r = at(right, i) - system_at(e, spread_start, i);
        const float16 s = at(right, i) - system_at(e, last_start, i);
        put(spread_residual, i, r);
        put(last_residual, i, s);
        spread_norm += r * r;
        last_norm += s * s;
    }
    row_norms[get_group_id(0)] = (float2)(sum_of_lanes(spread_norm), sum_of_lanes(last_norm));
}

/* Takes the better start into x and r, where the spread one stands; the other's vectors become the empty directions. */
__kernel void choose_start(__global const float2 *row_norms, Cells x, Cells r, Cells direction, Cells product)
{
    const float2 norms = sum_of_rows(row_norms);
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        if (norms.y < norms.x) {
            put(x, i, at(direction, i));
            put(r, i, at(product, i));
        }
        put(direction, i, 0.0f);
        put(product, i, 0.0f);
    }
}

/* State of the conjugate gradient after each step; steps[0] before the first. */
typedef struct {
    float squared_residual;
    float alpha;
    int done; /* converged, or nothing to solve */
} Step;

/* w = A' r; row_dots: (r . r, w . r) in the row. */
__kernel void residual_product(ConstCells e, ConstCells r, Cells w, __global float2 *row_dots,
                               __global const Step *steps, int step)
{
    if (steps[step].done)
        return;
    float16 rr = 0.0f, wr = 0.0f;
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        const float16 here = at(r, i), product = system_at(e, r, i);
        put(w, i, product);
        rr += here * here;
        wr += product * here;
    }
    row_dots[get_group_id(0)] = (float2)(sum_of_lanes(rr), sum_of_lanes(wr));
}

/* One step: directions, solution and residual. Converged at a residual of `tolerance` times the right-hand side. */
__kernel void advance_rows(__global const float2 *row_dots, __global const float *row_norms, __global Step *steps,
                           int step, Cells r, ConstCells w, Cells direction, Cells product, Cells x, float tolerance)
{
    const Step before = steps[step];
    Step now = before;
    float beta = 0.0f;
    if (!before.done) {
        const float norm = sum_of_norms(row_norms);
        const float2 dots = sum_of_rows(row_dots);
        beta = step ? dots.x / before.squared_residual : 0.0f;
        const float curvature = dots.y - (step ? beta * dots.x / before.alpha : 0.0f);
        now.squared_residual = dots.x;
        now.alpha = dots.x / curvature;
        now.done = !(dots.x > tolerance * tolerance * norm && curvature > 0.0f);
    }
    /* Here, and not in the branch above: with the store at the end and the cells in the branch PoCL 7.1 went over some
     * grids' cells twice. */
    if (get_group_id(0) == 0)
        steps[step + 1] = now;
    if (now.done)
        return;
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        const float16 p = at(r, i) + beta * at(direction, i), s = at(w, i) + beta * at(product, i);
        put(direction, i, p);
        put(product, i, s);
        put(x, i, at(x, i) + now.alpha * p);
        put(r, i, at(r, i) - now.alpha * s);
    }
}

/* solution = d x: plane positions; NAN where nothing is known at all. relative_residual: what is left of the residual,
 * in parts of the right-hand side; by the residual before the last step, which was measured. */
__kernel void finish_rows(ConstCells x, ConstCells d, __global const float2 *row_sums, Cells solution,
                          __global const float *row_norms, __global const Step *last, int step,
                          __global float *relative_residual)
{
    if (get_group_id(0) == 0) {
        const float norm = sum_of_norms(row_norms);
        *relative_residual = norm > 0.0f ? sqrt(last[step].squared_residual / norm) : 0.0f;
    }
    const float16 known = sum_of_rows(row_sums).y > 0.0f ? 0.0f : NAN;
    for (int i = first_cell(), end = i + ROW; i < end; i += 16)
        put(solution, i, known + at(d, i) * at(x, i));
}
