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

#define CENTRE_WEIGHT 10.0f
#define EPSILON 1e-6f

typedef __global float *Cells;
typedef __global const float *ConstCells;

inline float16 at(ConstCells v, int i)
{
    return *(__global const flanes *)(v + i);
}

inline void put(Cells v, int i, float16 value)
{
    *(__global flanes *)(v + i) = value;
}

inline float16 neighbours(ConstCells v, int i)
{
    return at(v, i - 1) + at(v, i + 1) + at(v, i - COLUMN) + at(v, i + COLUMN) + at(v, i - ROW) + at(v, i + ROW);
}

/* (A' x)_i */
inline float16 system_at(ConstCells e, ConstCells x, int i)
{
    const float16 sum = at(e, i - 1) * at(x, i - 1) + at(e, i + 1) * at(x, i + 1) +
                        at(e, i - COLUMN) * at(x, i - COLUMN) + at(e, i + COLUMN) * at(x, i + COLUMN) +
                        at(e, i - ROW) * at(x, i - ROW) + at(e, i + ROW) * at(x, i + ROW);
    return at(x, i) - at(e, i) * sum;
}

inline float sum_of_lanes(float16 v)
{
    const float8 a = v.lo + v.hi;
    const float4 b = a.lo + a.hi;
    const float2 c = b.lo + b.hi;
    return c.lo + c.hi;
}

/* Sum over the grid of what each row gives. */
inline float2 sum_of_rows(__global const float2 *row_sums)
{
    float2 sum = 0.0f;
    for (int i = 0; i < ROWS; i++)
        sum += row_sums[i];
    return sum;
}

/* First cell of the work-item's row. */
inline int first_cell(void)
{
    return ((int)get_group_id(0) + 1) * ROW;
}

/* The part of the picture under a column of the grid, in strips 16 pixels wide: steps of luma, and planes. What fills
 * the last vector counts nowhere. */
#define STRIPS ((SIGMA_XY + 15) / 16)
#define STRIP_VECTORS ((SIGMA_XY + 3) / 4)
#define AHEAD 256   /* columns asked for ahead */
#define OUTSIDE 255 /* not a step of luma, whose least size is 4 */
typedef struct {
    uchar64 steps[STRIPS][STRIP_VECTORS], planes[STRIPS][STRIP_VECTORS];
    int first, last; /* steps among them */
} Area;

inline uchar lowest(uchar16 v)
{
    const uchar8 a = min(v.lo, v.hi);
    const uchar4 b = min(a.lo, a.hi);
    const uchar2 c = min(b.lo, b.hi);
    return min(c.lo, c.hi);
}

inline void load_area(__global const uchar *sparse, __global const uchar *luma, int left, int top, int width,
                      int height, Area *area)
{
    const int right = min(left + SIGMA_XY, width), bottom = min(top + SIGMA_XY, height);
    uchar16 least = OUTSIDE, most = 0;
    for (int i = 0; i < STRIPS * STRIP_VECTORS; i++)
        area->steps[0][i] = OUTSIDE;
    for (int x = left; x < right; x += 16) {
        uchar *steps = (uchar *)area->steps[(x - left) / 16], *planes = (uchar *)area->planes[(x - left) / 16];
        const int first = min(x, width - 16); /* at the right border the lanes before come along */
        const char16 column = convert_char16(LANE) + (char)(first - x);
        const uchar16 outside = as_uchar16(column < (char)0 || column >= (char)min(right - x, 16));
        for (int y = top; y < bottom; y++, steps += 16, planes += 16) {
            const ulong pixel = (ulong)y * width + first;
            PREFETCH(luma + pixel + AHEAD);
            PREFETCH(sparse + pixel + AHEAD);
            const ushort16 pixels = convert_ushort16(*(__global const lanes8 *)(luma + pixel));
            const uchar16 step = convert_uchar16(pixels / (ushort)SIGMA_LUMA);
            *(lanes8 *)steps = step | outside;
            *(lanes8 *)planes = *(__global const lanes8 *)(sparse + pixel);
            least = min(least, step | outside);
            most = max(most, step & ~outside);
        }
    }
    area->first = lowest(least);
    area->last = 255 - lowest(~most);
}

inline float sum_of_shorts(ushort32 v)
{
    const uint16 a = (as_uint16(v) & 65535u) + (as_uint16(v) >> 16);
    const uint8 b = a.lo + a.hi;
    const uint4 c = b.lo + b.hi;
    const uint2 d = c.lo + c.hi;
    return (float)(d.lo + d.hi);
}

inline ushort32 sum_bytes(uchar64 v)
{
    return even_bytes(as_ushort32(v)) + odd_bytes(as_ushort32(v));
}

/* Pixels of an area in a step of luma, known ones, and the sum of their planes. */
inline float3 count_step(const Area *area, uchar step)
{
    float3 sums = 0.0f;
    for (int strip = 0; strip < STRIPS; strip++) {
        ushort32 pixels = 0, known = 0, planes = 0;
        for (int i = 0; i < STRIP_VECTORS; i++) {
            const uchar64 plane = area->planes[strip][i];
            const uchar64 counts = __builtin_astype(area->steps[strip][i] == step, uchar64);
            const uchar64 tells = counts & __builtin_astype(plane != (uchar)UNKNOWN_PLANE, uchar64);
            pixels += sum_bytes(counts & (uchar)1);
            known += sum_bytes(tells & (uchar)1);
            planes += sum_bytes(tells & plane);
        }
        sums += (float3)(sum_of_shorts(pixels), sum_of_shorts(known), sum_of_shorts(planes));
    }
    return sums;
}

/* mass: pixels a cell holds; weight, target: known ones, sum of their planes; n: 1 where there are any.
 * row_sums: (target, weight) of the row. */
__kernel void splat_rows(__global const uchar *sparse, __global const uchar *luma, Cells mass, Cells weight,
                         Cells target, Cells n, __global float2 *row_sums, int width, int height)
{
    const int top = (int)get_group_id(0) * SIGMA_XY;
    float2 sums = 0.0f;
    int cell = first_cell() + COLUMN + 1;
    for (int left = 0; left < width; left += SIGMA_XY, cell += COLUMN) {
        Area area;
        load_area(sparse, luma, left, top, width, height, &area);
        for (int step = 0; step < COLUMN - 1; step++) {
            float3 count = 0.0f;
            if (step >= area.first && step <= area.last)
                count = count_step(&area, (uchar)step);
            mass[cell + step] = count.x;
            weight[cell + step] = count.y;
            target[cell + step] = count.z;
            n[cell + step] = count.x > 0.0f ? 1.0f : 0.0f;
            sums += count.zy;
        }
    }
    row_sums[get_group_id(0)] = sums;
}

/* One step of bistochastisation, n -> next. */
__kernel void normalise_rows(ConstCells mass, ConstCells n, Cells next)
{
    for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
        const float16 m = at(mass, i), here = at(n, i);
        const float16 blurred = CENTRE_WEIGHT * here + neighbours(n, i);
        put(next, i, m > 0.0f ? sqrt(here * m / blurred) : 0.0f);
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
        const float16 scale = 1.0f / sqrt(lambda * here * neighbours(n, i) + at(weight, i) + EPSILON);
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

inline void spread_cells(ConstCells from, Cells to, int first)
{
    for (int i = first; i < first + ROW; i += 16)
        put(to, i, at(from, i) + KEEP_LUMA * (at(from, i - 1) + at(from, i + 1)));
    for (int column = 2; column <= COLUMNS; column++)
        for (int i = first + column * COLUMN; i < first + (column + 1) * COLUMN; i++)
            to[i] += KEEP_XY * to[i - COLUMN];
    for (int column = COLUMNS - 1; column >= 1; column--)
        for (int i = first + column * COLUMN; i < first + (column + 1) * COLUMN; i++)
            to[i] += KEEP_XY * to[i + COLUMN];
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
    float norm = 0.0f;
    for (int i = 0; i < ROWS; i++)
        norm += row_norms[i];
    if (!before.done) {
        const float2 dots = sum_of_rows(row_dots);
        const float beta = step ? dots.x / before.squared_residual : 0.0f;
        const float curvature = dots.y - (step ? beta * dots.x / before.alpha : 0.0f);
        now.squared_residual = dots.x;
        now.alpha = dots.x / curvature;
        now.done = !(dots.x > tolerance * tolerance * norm && curvature > 0.0f);
        if (!now.done)
            for (int i = first_cell(), end = i + ROW; i < end; i += 16) {
                const float16 p = at(r, i) + beta * at(direction, i), s = at(w, i) + beta * at(product, i);
                put(direction, i, p);
                put(product, i, s);
                put(x, i, at(x, i) + now.alpha * p);
                put(r, i, at(r, i) - now.alpha * s);
            }
    }
    if (get_group_id(0) == 0)
        steps[step + 1] = now;
}

/* solution = d x: plane positions; NAN where nothing is known at all. relative_residual: what is left of the residual,
 * in parts of the right-hand side; by the residual before the last step, which was measured. */
__kernel void finish_rows(ConstCells x, ConstCells d, __global const float2 *row_sums, Cells solution,
                          __global const float *row_norms, __global const Step *last, int step,
                          __global float *relative_residual)
{
    if (get_group_id(0) == 0) {
        float norm = 0.0f;
        for (int i = 0; i < ROWS; i++)
            norm += row_norms[i];
        *relative_residual = norm > 0.0f ? sqrt(last[step].squared_residual / norm) : 0.0f;
    }
    const float16 known = sum_of_rows(row_sums).y > 0.0f ? 0.0f : NAN;
    for (int i = first_cell(), end = i + ROW; i < end; i += 16)
        put(solution, i, known + at(d, i) * at(x, i));
}
