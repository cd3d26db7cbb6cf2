/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * How much blur differs from plane to plane, read from how fast focus falls beside its peak: over the tenth of cells where
 * a peak k that is no end plane is highest,
 *
 *     rho = median of (E[k-1] + E[k+1]) / (2 E[k]),  E less its floor, the median over all cells of min_z E
 *
 * A scale's rho depends on nothing but the blur step in its cells: see BlurStep.
 */
#include "low_picture.cl"

#define BINS 256

/* least = min_z E. Work-items (1, height). */
__kernel void find_least(__global const short *focus, __global float *least, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    for (int x = 0; x < width; x += 16) {
        short16 lowest = READ_SHORTS(focus + row + x);
        for (int z = 1; z < planes; z++)
            lowest = min(lowest, READ_SHORTS(focus + z * plane + row + x));
        WIDE(least + row + x) = convert_float16(lowest);
    }
}

/* strength: E[k], 0 where k is an end plane; ratio: its rho. floor: as least. Work-items (1, height). */
__kernel void find_peaks(__global const short *focus, __global const float *floor, __global float *strength,
                         __global float *ratio, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const short16 least = (short16)(short)(*floor + 0.5f);
    for (int x = 0; x < width; x += 16) {
        __global const short *cells = focus + row + x;
        short16 before = 0, here = 0, after = 0, last = READ_SHORTS(cells), next = READ_SHORTS(cells + plane);
        short16 highest = last, is_inside = 0;
        for (int z = 1; z < planes; z++) {
            const short16 current = next;
            next = READ_SHORTS(cells + min(z + 1, planes - 1) * plane);
            const short16 is_higher = current > highest;
            highest = max(highest, current);
            is_inside = select(is_inside, (short16)(z < planes - 1 ? -1 : 0), is_higher);
            before = select(before, last, is_higher);
            here = select(here, current, is_higher);
            after = select(after, next, is_higher);
            last = current;
        }
        const float16 peak = convert_float16(max(here - least, (short16)0)) * convert_float16(is_inside & (short16)1);
        const float16 sides = convert_float16(max(before - least, (short16)0)) + convert_float16(max(after - least, (short16)0));
        WIDE(strength + row + x) = peak;
        WIDE(ratio + row + x) = sides / (2.0f * max(peak, (float16)1.0f));
    }
}

/* rho, 2 where less than 50 cells have a peak. One work-item. */
__kernel void judge_peaks(__global const float *strength, __global const float *ratio, __global float *rho, int width,
                          int height, int stride)
{
    uint strengths[BINS], ratios[BINS], count = 0, strong = 0;
    for (int i = 0; i < BINS; i++)
        strengths[i] = ratios[i] = 0;
    const int step = width * height > 65536 ? 3 : 1;
    /* Eight bins an octave. */
#define BIN_OF(value) min((as_uint(1.0f + (value)) - as_uint(1.0f)) >> 20, (uint)(BINS - 1))
    for (int y = 0; y < height; y += step)
        for (int x = 0; x < width; x += step) {
            const float value = strength[(size_t)y * stride + SIDE + x];
            if (value <= 0.0f)
                continue;
            strengths[BIN_OF(value)]++;
            count++;
        }
    uint least = BINS - 1;
    for (uint above = strengths[least]; least > 0 && 10 * above < count; above += strengths[least])
        least--;
    for (int y = 0; y < height; y += step)
        for (int x = 0; x < width; x += step) {
            const size_t cell = (size_t)y * stride + SIDE + x;
            if (strength[cell] <= 0.0f || BIN_OF(strength[cell]) < least)
                continue;
            ratios[min((uint)(ratio[cell] * BINS), (uint)(BINS - 1))]++;
            strong++;
        }
    uint below = 0;
    int bin = 0;
    while (bin < BINS - 1 && 2 * (below + ratios[bin]) < strong)
        below += ratios[bin++];
    *rho = count < 50 ? 2.0f : (bin + (0.5f * strong - below) / max(ratios[bin], 1u)) / BINS;
}
