/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as light_field_views.cl, for CPUs: a work-item is a strip of rows of all views, whose arrays stay in the core's
 * cache. 16 pixels at a time are computed; only the way from a pixel of the view to those of the row is walked one by one.
 */
#include "light_field_row.cl"

/* What one row of a view needs. */
typedef struct {
    __global float *places; /* of the row's pixels in the view */
    __global int *columns;  /* the first column of the view at or behind each */
    __global int *seen;     /* the row's pixel that each column shows, or shows what follows it */
    __global float2 *ends;  /* places of that pixel and the next */
    __global uint2 *colors; /* and their colours */
} Painter;

inline Painter make_painter(__global uint *scratch, int width, int view_width)
{
    const int pitch = PITCH(width), view_pitch = PITCH(view_width);
    const Painter painter = {(__global float *)scratch, (__global int *)scratch + pitch, (__global int *)scratch + 2 * pitch,
                             (__global float2 *)(scratch + 2 * pitch + view_pitch),
                             (__global uint2 *)(scratch + 2 * pitch + 3 * view_pitch)};
    return painter;
}

/* Finds which pixel each column of the view shows: the last one that stands at or before it. The view's columns are at
 * first + scale x. */
inline void find_seen(const Painter *painter, const Row *row, float slope, float first, float scale, int width)
{
    for (int j = 0; j < row->width; j += 16) {
        const float16 place = LANES + (float)j - slope * *(__global const float16 *)(row->height + j);
        *(__global float16 *)(painter->places + j) = place;
        *(__global int16 *)(painter->columns + j) = first_behind(place, first, 1.0f / scale, width);
    }
    for (int x = 0; x < width; x += 16)
        *(__global int16 *)(painter->seen + x) = 0;
    for (int j = 0; j < row->width - 1; j++)
        painter->seen[painter->columns[j]] = j;
    int last = 0;
    for (int x = 0; x < width; x++) {
        last = max(last, painter->seen[x]);
        painter->seen[x] = last;
        painter->ends[x] = *(__global const float2_any *)(painter->places + last);
        painter->colors[x] = *(__global const uint2_any *)(row->color + last);
    }
}

/* The colours of 4 columns, `share` of the way from their pixels to the next ones. */
inline uint4 mix_colors(uint8 colors, float4 share)
{
    const float16 from = convert_float16(as_uchar16(colors.even)), to = convert_float16(as_uchar16(colors.odd));
    return as_uint4(convert_uchar16(from + (to - from) * share.s0000111122223333 + 0.5f));
}

inline void put_packed(__global uchar *line, int x, int channels, uint color)
{
    const uchar4 value = as_uchar4(color);
    if (channels == 4) {
        *(__global uchar4 *)(line + 4 * x) = (uchar4)(value.xyz, 255);
        return;
    }
    line[3 * x] = value.x;
    line[3 * x + 1] = value.y;
    line[3 * x + 2] = value.z;
}

/* The columns of a view to `line`, from the right if `mirror` is set. */
inline void paint(const Layers *layers, const Painter *painter, const Row *row, float slope, float first, float scale,
                  int width, int mirror, __global uchar *line, int channels)
{
    /* A view without parallax has no steps to look behind. */
    const bool flat = slope * (layers->heights.y - layers->heights.x) < 1e-3f;
    slope = flat ? 0.0f : slope;
    find_seen(painter, row, slope, first, scale, width);
    /* From a pixel to the next one that is lower by a step it is farther than that. */
    const float torn_apart = flat ? INFINITY : 1.0f + slope * layers->step + TOUCH;
    for (int x = 0; x < width; x += 4) {
        const float4 place = first + scale * ((float4)(0, 1, 2, 3) + (float)x);
        const float8 ends = *(__global const float8 *)(painter->ends + x);
        const float4 span = ends.odd - ends.even, beside = place - ends.even;
        uint4 colors = mix_colors(*(__global const uint8 *)(painter->colors + x), beside / span);
        const int4 torn = span > torn_apart && beside > TOUCH;
        if (any(torn)) {
            const float places[4] = {place.s0, place.s1, place.s2, place.s3};
            const int is_torn[4] = {torn.s0, torn.s1, torn.s2, torn.s3};
            uint behind[4] = {colors.s0, colors.s1, colors.s2, colors.s3};
            for (int i = 0; i < min(4, width - x); i++)
                if (is_torn[i])
                    behind[i] = as_uint(convert_uchar4(look_behind(row, places[i], painter->seen[x + i], slope, layers->step,
                                                                   layers->heights.x, layers->fill) + 0.5f));
            colors = (uint4)(behind[0], behind[1], behind[2], behind[3]);
        }
        if (channels == 4 && x + 4 <= width) {
            const int start = mirror ? width - 4 - x : x;
            *(__global uint4_any *)(line + 4 * start) = (mirror ? colors.s3210 : colors) | 0xff000000u;
            continue;
        }
        const uint each[4] = {colors.s0, colors.s1, colors.s2, colors.s3};
        for (int i = 0; i < min(4, width - x); i++)
            put_packed(line, mirror ? width - 1 - x - i : x + i, channels, each[i]);
    }
}

inline void blacken(__global uchar *line, int from, int to, int channels)
{
    for (int x = from; x < to; x++)
        put_packed(line, x, channels, 0);
}

/* Arguments as those of views; and the row's first column and width, and scratch_size elements of scratch for each
 * work-item. Work-items (strips). */
__kernel void view_rows(LAYERS, __global const float *slopes, int2 columns_rows, int2 view, int base, int width,
                        __global uint *scratch, int scratch_size, float2 first, float2 scale, __global uchar *output,
                        ulong stride, int channels, int2 output_size)
{
    const Layers layers = MAKE_LAYERS;
    const int strip = (int)get_global_id(0), strips = (int)get_global_size(0);
    scratch += (size_t)strip * scratch_size;
    const Row row = make_row(&scratch, width), mirrored = make_row(&scratch, width);
    const Painter painter = make_painter(scratch, width, view.x);
    const int left_over = output_size.y - columns_rows.y * view.y, rows = view.y + left_over;
    for (int y = rows * strip / strips; y < rows * (strip + 1) / strips; y++) {
        if (y >= view.y) {
            blacken(output + stride * (ulong)(y - view.y), 0, output_size.x, channels);
            continue;
        }
        const float point_y = clamp(first.y + scale.y * y, 0.0f, size.y - 1.0f);
        load_heights(&layers, convert_int_rte(point_y), base, &row, &mirrored);
        load_colors(&layers, point_y, base, &row, &mirrored);
        for (int r = 0; r < columns_rows.y; r++) {
            __global uchar *line = output + stride * (ulong)(output_size.y - (r + 1) * view.y + y);
            for (int column = 0; column < columns_rows.x; column++) {
                const float slope = slopes[r * columns_rows.x + column];
                const int mirror = slope < 0.0f;
                const float start = mirror ? width - 1 - (first.x + scale.x * (view.x - 1) - base) : first.x - base;
                paint(&layers, &painter, mirror ? &mirrored : &row, fabs(slope), start, scale.x, view.x, mirror,
                      line + column * view.x * channels, channels);
            }
            blacken(line, columns_rows.x * view.x, output_size.x, channels);
        }
    }
}
