/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as lenticular of light_field_panel.cl, for CPUs: a work-item is a strip of the panel's rows. Each subpixel has a
 * slope of its own; the pixel it sees is sought only between those that two of BINS + 1 slopes around it see, since rays
 * through one point hit the relief in the order of their slopes. 16 of them search in step.
 */
#include "light_field_row.cl"
#include "lanes16.cl"

#define BINS 8 /* from the slope 0 to the greatest, in each direction */
#define BIN_STEPS 32 /* slopes in the table for each of them */
#define ODD_LANES (int16)(0, -1, 0, -1, 0, -1, 0, -1, 0, -1, 0, -1, 0, -1, 0, -1)

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
        }
        int end = width;
        for (int j = width - 2; j >= 0; j--)
            while (end > behind[j])
                seen[--end] = (ushort)j;
        while (end > 0)
            seen[--end] = 0;
    }
}

/* The channel c of what 16 rays see at the places s, at its bits of a pixel. Steps in the table of slopes are below 0 for rays
 * that lean to the left and see the row `mirrored`, whose arrays lie as far behind the row's as one's do behind another's. */
inline uint16 look_at(const Layers *layers, const Side *side, const Side *mirrored, __global const float *slopes, float16 s,
                      float16 step, int c)
{
    const Row *row = &side->row;
    const int pitch = PITCH(row->width);
    const int16 turned = step < 0.0f;
    const float16 from_middle = fabs(step), place = turned ? row->width - 1 - s : s;
    const int16 before = min(convert_int16(from_middle), (int16)(BINS * BIN_STEPS - 1));
    const float16 less = GATHER(float16, slopes, before), more = GATHER(float16, slopes, (before + 1));
    const float16 slope = less + (more - less) * (from_middle - convert_float16(before));

    const int16 bin = (before / BIN_STEPS + (turned ? BINS + 1 : 0)) * pitch + convert_int16(place) + 1;
    const int16 start = convert_int16(max(GATHER(ushort16, side->seen, bin), GATHER(ushort16, side->seen, (bin + pitch))));
    const int16 offset = turned ? (int)(mirrored->row.height - row->height) : 0;
    int16 j = start;
    float16 height = 0.0f;
    for (int16 beyond = -1, at = start; any(beyond); at = max(at - 1, (int16)0)) {
        const float16 here = GATHER(float16, row->height, (offset + at));
        height = beyond ? here : height;
        j = beyond ? at : j;
        beyond = beyond && at > 0 && convert_float16(at) - slope * here > place;
    }

    const int16 pixel = offset + j;
    const float16 fall = height - GATHER(float16, row->height, (pixel + 1));
    const float16 beside = place - (convert_float16(j) - slope * height);
    const uint16 left = GATHER(uint16, row->color, pixel), right = GATHER(uint16, row->color, (pixel + 1));
    const float16 from = channel_of(left, 8 * c), to = channel_of(right, 8 * c);
    float16 value = from + (to - from) * (beside / (1.0f + slope * fall));
    const int16 torn = fall > layers->step && beside > TOUCH && slope * (layers->heights.y - layers->heights.x) >= 1e-3f;
    if (any(torn))
        for (int i = 0; i < 16; i++)
            if (EACH(int, torn)[i]) {
                const float4 color = look_behind(EACH(int, turned)[i] ? &mirrored->row : row, EACH(float, place)[i],
                                                 EACH(int, j)[i], EACH(float, slope)[i], layers->step, layers->heights.x,
                                                 layers->fill);
                EACH(float, value)[i] = c == 0 ? color.x : c == 1 ? color.y : color.z;
            }
    return convert_uint16(convert_int16(value + 0.5f)) << (8 * c);
}

/* Arguments as those of lenticular; and slopes of BINS * BIN_STEPS + 1 turns from the middle to the edge of the cone, the
 * row's first column and width, and scratch_size elements of scratch for each work-item. Work-items (strips). */
__kernel void lenticular_rows(LAYERS, float pitch, float tilt, float center, __global const float *slopes,
                              __global const float *shifts, int4 flips, int base, int width, __global uint *scratch,
                              int scratch_size, float2 first, float2 scale, __global uchar *output, ulong stride, int channels,
                              int2 output_size)
{
    const Layers layers = MAKE_LAYERS;
    const int strip = (int)get_global_id(0), strips = (int)get_global_size(0);
    scratch += (size_t)strip * scratch_size;
    const Row row = make_row(&scratch, width), mirrored_row = make_row(&scratch, width);
    __global int *behind = (__global int *)scratch;
    __global ushort *seen = (__global ushort *)(scratch + PITCH(width));
    const Side side = {row, seen}, mirrored = {mirrored_row, seen + (BINS + 1) * PITCH(width)};
    const float per_pixel = pitch / output_size.x;
    const float steps = (flips.z ? -2.0f : 2.0f) * (BINS * BIN_STEPS); /* in the table of slopes, from view to view */
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
        const float start = 0.5f * per_pixel + tilt * from_bottom * pitch - center;
        __global const float *shift = shifts + 6 * (output_size.y - 1 - y & 3);
        __global uchar *line = output + stride * (ulong)y;
        for (int x = 0; x < output_size.x; x += 16) {
            const float16 column = min(LANES16 + (float)x, output_size.x - 1.0f);
            const float16 s = first.x + scale.x * (flips.x ? output_size.x - 1 - column : column) - base;
            uint16 colors = OPAQUE;
            for (int c = 0; c < 3; c++) {
                const float16 shifted = ODD_LANES ? (float16)shift[3 + c] : (float16)shift[c];
                const float16 lens = start + column * per_pixel + shifted * pitch;
                const float16 fraction = lens - convert_float16(convert_int16(lens));
                const float16 view = fraction < 0.0f ? fraction + 1.0f : fraction;
                colors |= look_at(&layers, &side, &mirrored, slopes, s, (view - 0.5f) * steps, c);
            }
            put_colors(line, x, min(16, output_size.x - x), channels, colors);
        }
    }
}
