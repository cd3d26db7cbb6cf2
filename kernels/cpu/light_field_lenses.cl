/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as lenticular of light_field_panel.cl, for CPUs: a work-item is a strip of the panel's rows. Each subpixel has a
 * slope of its own; the pixel it sees is sought only between those that two of BINS + 1 slopes around it see, since rays
 * through one point hit the relief in the order of their slopes.
 */
#include "light_field_row.cl"

#define BINS 4 /* from the slope 0 to the greatest, in each direction */
#define BIN_STEPS 64 /* slopes in the table for each of them */

/* The relief's row from one side. */
typedef struct {
    Row row;
    __global ushort *seen; /* for each of BINS + 1 slopes, the last pixel that stands at or before each place */
} Side;

inline void find_seen(const Side *side, __global const float *slopes, __global int *behind)
{
    const int width = side->row.width;
    __global ushort *seen = side->seen;
    for (int bin = 0; bin <= BINS; bin++, seen += PITCH(width)) {
        const float slope = slopes[bin * BIN_STEPS];
        for (int j = 0; j < width; j += 16) {
            const float16 place = LANES + (float)j - slope * *(__global const float16 *)(side->row.height + j);
            *(__global int16 *)(behind + j) = first_behind(place, 0.0f, 1.0f, width);
            *(__global ushort16 *)(seen + j) = 0;
        }
        for (int j = 0; j < width - 1; j++)
            seen[behind[j]] = (ushort)j;
        int last = 0;
        for (int j = 0; j < width; j++) {
            last = max(last, (int)seen[j]);
            seen[j] = (ushort)last;
        }
    }
}

/* For each subpixel of a panel's row, from the left, its view as a step in the table of slopes, below 0 to the left of the
 * middle: the subpixel i belongs to fract(start + i per_subpixel). */
inline void find_steps(__global float *steps, int count, float start, float per_subpixel, int invert)
{
    const float scale = (invert ? -2.0f : 2.0f) * (BINS * BIN_STEPS);
    for (int i = 0; i < count; i += 16) {
        const float16 place = start + (LANES + (float)i) * per_subpixel;
        float16 view = place - convert_float16(convert_int16(place));
        view = view < 0.0f ? view + 1.0f : view;
        *(__global float16 *)(steps + i) = (view - 0.5f) * scale;
    }
}

/* The channel c of what is seen at the place s. */
inline float look_at(const Layers *layers, const Side *side, __global const float *slopes, float s, float step, int c)
{
    const int before = min((int)step, BINS * BIN_STEPS - 1);
    const float slope = mix(slopes[before], slopes[before + 1], step - before);
    __global const float *height = side->row.height;
    __global const ushort *seen = side->seen + (before / BIN_STEPS) * PITCH(side->row.width) + (int)s + 1;
    int j = max(seen[0], seen[PITCH(side->row.width)]);
    while (j - slope * height[j] > s)
        j--;
    const float fall = height[j] - height[j + 1], beside = s - (j - slope * height[j]);
    if (fall > layers->step && beside > TOUCH && slope * (layers->heights.y - layers->heights.x) >= 1e-3f) {
        const float4 color = look_behind(&side->row, s, j, slope, layers->step, layers->heights.x, layers->fill);
        return c == 0 ? color.x : c == 1 ? color.y : color.z;
    }
    __global const uchar *color = (__global const uchar *)(side->row.color + j) + c;
    return mix((float)color[0], (float)color[4], beside / (1.0f + slope * fall));
}

/* Arguments as those of lenticular; and slopes of BINS * BIN_STEPS + 1 turns from the middle to the edge of the cone, the
 * row's first column and width, and scratch_size elements of scratch for each work-item. Work-items (strips). */
__kernel void lenticular_rows(LAYERS, float pitch, float tilt, float center, __global const float *slopes, int4 subpixels,
                              int4 flips, int base, int width, __global uint *scratch, int scratch_size, float2 first,
                              float2 scale, __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const Layers layers = MAKE_LAYERS;
    const int strip = (int)get_global_id(0), strips = (int)get_global_size(0);
    scratch += (size_t)strip * scratch_size;
    const Row row = make_row(&scratch, width), mirrored_row = make_row(&scratch, width);
    __global int *behind = (__global int *)scratch;
    __global float *steps = (__global float *)(scratch + PITCH(width));
    __global ushort *seen = (__global ushort *)(steps + PITCH(3 * output_size.x));
    const Side side = {row, seen}, mirrored = {mirrored_row, seen + (BINS + 1) * PITCH(width)};
    const int channel[3] = {subpixels.x, subpixels.y, subpixels.z};
    const float per_subpixel = pitch / (3.0f * output_size.x);
    int loaded = -1;
    for (int y = output_size.y * strip / strips; y < output_size.y * (strip + 1) / strips; y++) {
        const float point_y = clamp(first.y + scale.y * (flips.y ? output_size.y - 1 - y : y), 0.0f, size.y - 1.0f);
        const int nearest = convert_int_rte(point_y);
        if (nearest != loaded) {
            load_heights(&layers, nearest, base, &row, &mirrored_row);
            find_seen(&side, slopes, behind);
            find_seen(&mirrored, slopes, behind);
            loaded = nearest;
        }
        load_colors(&layers, point_y, base, &row, &mirrored_row);
        const float from_bottom = 1.0f - (y + 0.5f) / output_size.y;
        find_steps(steps, 3 * output_size.x, 1.5f * per_subpixel + tilt * from_bottom * pitch - center, per_subpixel, flips.z);
        __global uchar *pixel = output + stride * (ulong)y;
        for (int x = 0; x < output_size.x; x++, pixel += channels) {
            const float s = first.x + scale.x * (flips.x ? output_size.x - 1 - x : x) - base;
            for (int k = 0; k < 3; k++) {
                const float step = steps[3 * x + k];
                const int c = channel[k];
                const float value = step < 0.0f ? look_at(&layers, &mirrored, slopes, width - 1 - s, -step, c)
                                                : look_at(&layers, &side, slopes, s, step, c);
                pixel[c] = (uchar)(value + 0.5f);
            }
            if (channels == 4)
                pixel[3] = 255;
        }
    }
}
