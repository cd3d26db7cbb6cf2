/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as lenticular of light_field_panel.cl, for CPUs: a work-item is a strip of the panel's rows. Each subpixel has a
 * slope of its own; the pixel it sees is sought only between those that two of BINS + 1 slopes around it see, since rays
 * through one point hit the relief in the order of their slopes.
 */
#include "light_field_row.cl"

#define BINS 24 /* from the slope 0 to the greatest, in each direction */
#define BIN_STEPS 16 /* slopes in the table for each of them */

/* For each of the slopes, the last pixel that stands at or before each place of the row. */
inline void find_seen(const Row *row, __global const float *slopes, __global ushort *seen)
{
    const int pitch = PITCH(row->width);
    for (int bin = 0; bin <= BINS; bin++, seen += pitch) {
        const float slope = slopes[bin * BIN_STEPS];
        for (int j = 0; j < row->width; j++)
            seen[j] = 0;
        for (int j = 0; j < row->width - 1; j++) {
            const float place = j - slope * row->height[j];
            const int behind = (int)place + (place > 0.0f);
            if (behind < row->width)
                seen[max(behind, 0)] = (ushort)j;
        }
        ushort last = 0;
        for (int j = 0; j < row->width; j++) {
            last = max(last, seen[j]);
            seen[j] = last;
        }
    }
}

/* The channel c of what is seen at the place s from the slope `turn` of the way from the middle to the edge of the cone. */
inline float look_at(const Layers *layers, const Row *row, __global const ushort *seen, __global const float *slopes, float s,
                     float turn, int c)
{
    const float entry = turn * (BINS * BIN_STEPS);
    const int before = min((int)entry, BINS * BIN_STEPS - 1);
    const float slope = mix(slopes[before], slopes[before + 1], entry - before);
    const int pitch = PITCH(row->width);
    seen += (before / BIN_STEPS) * pitch + (int)s + 1;
    int j = max(seen[0], seen[pitch]);
    float height = row->height[j], place = j - slope * height;
    while (place > s) {
        j--;
        height = row->height[j];
        place = j - slope * height;
    }
    const float beside = s - place, next = row->height[j + 1];
    if (height - next > layers->step && beside > TOUCH && slope * (layers->heights.y - layers->heights.x) >= 1e-3f) {
        const float4 color = look_behind(row, s, j, slope, layers->step, layers->heights.x, layers->fill);
        return c == 0 ? color.x : c == 1 ? color.y : color.z;
    }
    __global const uchar *color = (__global const uchar *)(row->color + j) + c;
    return mix((float)color[0], (float)color[4], beside / (1.0f + slope * (height - next)));
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
    const Row row = make_row(&scratch, width), mirrored = make_row(&scratch, width);
    __global ushort *seen = (__global ushort *)scratch, *mirrored_seen = seen + (BINS + 1) * PITCH(width);
    const int k[3] = {subpixels.x, subpixels.y, subpixels.z};
    int loaded = -1;
    for (int y = output_size.y * strip / strips; y < output_size.y * (strip + 1) / strips; y++) {
        const float point_y = clamp(first.y + scale.y * (flips.y ? output_size.y - 1 - y : y), 0.0f, size.y - 1.0f);
        const int nearest = convert_int_rte(point_y);
        if (nearest != loaded) {
            load_heights(&layers, nearest, base, &row, &mirrored);
            find_seen(&row, slopes, seen);
            find_seen(&mirrored, slopes, mirrored_seen);
            loaded = nearest;
        }
        load_colors(&layers, point_y, base, &row, &mirrored);
        const float from_bottom = 1.0f - (y + 0.5f) / output_size.y;
        __global uchar *line = output + stride * (ulong)y;
        for (int x = 0; x < output_size.x; x++) {
            const float s = first.x + scale.x * (flips.x ? output_size.x - 1 - x : x) - base;
            const float from_left = (x + 0.5f) / output_size.x;
            float value[3];
            for (int c = 0; c < 3; c++) {
                const float place = (from_left + k[c] / (3.0f * output_size.x) + tilt * from_bottom) * pitch - center;
                float turn = 2.0f * (place - floor(place)) - 1.0f;
                turn = flips.z ? -turn : turn;
                value[c] = turn < 0.0f ? look_at(&layers, &mirrored, mirrored_seen, slopes, width - 1 - s, -turn, c)
                                       : look_at(&layers, &row, seen, slopes, s, turn, c);
            }
            put_color(line + x * channels, channels, (float4)(value[0], value[1], value[2], 255.0f));
        }
    }
}
