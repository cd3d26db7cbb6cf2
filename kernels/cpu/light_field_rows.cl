/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as light_field_views.cl, for CPUs: a work-item is a strip of rows of all views, whose arrays stay in the core's
 * cache. 16 pixels at a time are computed; only the way from a pixel of the view to those of the row is walked one by one.
 */
#include "light_field_row.cl"
#include "lanes16.cl"

/* What one row of a view needs. */
typedef struct {
    __global float *places; /* of the row's pixels in the view */
    __global int *columns;  /* the first column of the view at or behind each */
    __global int *seen;     /* the last of the row's pixels with this first column, or 0 */
} Painter;

inline Painter make_painter(__global uint *scratch, int width)
{
    const int pitch = PITCH(width);
    const Painter painter = {(__global float *)scratch, (__global int *)scratch + pitch, (__global int *)scratch + 2 * pitch};
    return painter;
}

/* Finds which pixel stands at or before each column of the view. The view's columns are at first + scale x. */
inline void find_seen(const Painter *painter, const Row *row, float slope, float first, float scale, int width)
{
    for (int j = 0; j < row->width; j += 16) {
        const float16 place = LANES + (float)j - slope * *(__global const float16 *)(row->height + j);
        *(__global float16 *)(painter->places + j) = place;
        *(__global int16 *)(painter->columns + j) = first_behind(place, first, 1.0f / scale, width);
    }
    __global int *restrict seen = painter->seen;
    __global const int *restrict columns = painter->columns;
    for (int x = 0; x < width; x += 16)
        *(__global int16 *)(seen + x) = 0;
    for (int j = 0, end = row->width - 1; j < end; j++)
        seen[columns[j]] = j;
}

/* The colours, `share` of the way from some pixels to others. */
inline uint16 mix_colors(uint16 left, uint16 right, float16 share)
{
    uint16 colors = OPAQUE;
    for (int shift = 0; shift < 24; shift += 8) {
        const float16 from = channel_of(left, shift), to = channel_of(right, shift);
        colors |= convert_uint16(convert_int16(from + (to - from) * share + 0.5f)) << shift;
    }
    return colors;
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
    int16 before = 0;
    for (int x = 0; x < width; x += 16) {
        const int16 seen = max(greatest_so_far(*(__global const int16 *)(painter->seen + x)), (int16)before.sf);
        const float16 place = first + scale * (LANES + (float)x);
        float16 left, right, left_color, right_color;
        gather_pairs(painter->places, seen, &left, &right);
        gather_pairs((__global const float *)row->color, seen, &left_color, &right_color);
        const float16 span = right - left, beside = place - left;
        uint16 colors = mix_colors(as_uint16(left_color), as_uint16(right_color), beside / span);
        const int16 torn = span > torn_apart && beside > TOUCH;
        const int count = min(16, width - x);
        if (any_of(torn))
            for (int i = 0; i < count; i++)
                if (EACH(const int, torn)[i]) {
                    const float4 color = look_behind(row, EACH(const float, place)[i], EACH(const int, seen)[i], slope,
                                                     layers->step, layers->heights.x, layers->fill);
                    EACH(uint, colors)[i] = as_uint(convert_uchar4(color + 0.5f)) | OPAQUE;
                }
        if (count == 16)
            put_colors(line, mirror ? width - 16 - x : x, 16, channels, mirror ? colors.sfedcba9876543210 : colors);
        else
            for (int i = 0; i < count; i++)
                put_packed(line, mirror ? width - 1 - x - i : x + i, channels, EACH(const uint, colors)[i]);
        before = seen;
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
    const Painter painter = make_painter(scratch, width);
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
