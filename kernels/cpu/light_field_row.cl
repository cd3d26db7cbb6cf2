/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * A row of the layers as views on CPUs look at it, without a search. The layers' pixel j of height h stands at j - slope h in
 * the view, and what lies between it and the next one stands between them. Seen from the right, that is with a slope above 0,
 * pixels farther right are nearer where places coincide: near surfaces win. Views from the left look at the mirrored row.
 */
#include "../light_field_trace.cl"

typedef float2 __attribute__((aligned(4))) float2_any;
typedef uint2 __attribute__((aligned(4))) uint2_any;
typedef uint4 __attribute__((aligned(4))) uint4_any;

#define LANES (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#define PITCH(width) (((width) + 31) / 16 * 16) /* of arrays, with room for whole lanes behind them */

/* `width` pixels of the layers, from the column `base` on; beyond its ends the layers' row goes on with its last pixels. */
typedef struct {
    __global float *height, *hidden_height;
    __global uint *color, *hidden_color;
    int width;
} Row;

/* Lays a row's arrays out in `scratch` and moves that behind them. */
inline Row make_row(__global uint **scratch, int width)
{
    const int pitch = PITCH(width);
    __global uint *start = *scratch;
    *scratch += 4 * pitch;
    const Row row = {(__global float *)start, (__global float *)(start + pitch), start + 2 * pitch, start + 3 * pitch, width};
    return row;
}

/* 4 pixels from x on, `share` of the way from one row to another. */
inline uint4 blend(__global const uchar4 *from, __global const uchar4 *to, int x, float share)
{
    const float16 a = convert_float16(as_uchar16(*(__global const uint4_any *)(from + x)));
    const float16 b = convert_float16(as_uchar16(*(__global const uint4_any *)(to + x)));
    return as_uint4(convert_uchar16(a + (b - a) * share + 0.5f));
}

/* The first of the places first + k / per_place, k in 0..last, at or behind each of 16 places; `last` behind the last one. */
inline int16 first_behind(float16 place, float first, float per_place, int last)
{
    const float16 exact = (place - first) * per_place;
    int16 behind = convert_int16(exact);
    behind -= convert_float16(behind) < exact;
    return behind < 0 ? 0 : behind > last ? last : behind;
}

/* The heights of the layers' row nearest to point_y, from the column `base` on. */
inline void load_heights(const Layers *layers, int y, int base, const Row *row, const Row *mirrored)
{
    __global const float *height = layers->height + (size_t)y * layers->size.x;
    __global const float *hidden = layers->hidden_height + (size_t)y * layers->size.x;
    for (int j = 0, k = row->width - 1; j < row->width; j++, k--) {
        const int x = clamp(base + j, 0, layers->size.x - 1);
        row->height[j] = mirrored->height[k] = height[x];
        row->hidden_height[j] = mirrored->hidden_height[k] = hidden[x];
    }
}

inline void repeat_ends(__global uint *row, int begin, int end, int width)
{
    for (int j = 0; j < begin; j++)
        row[j] = row[begin];
    for (int j = end; j < width; j++)
        row[j] = row[end - 1];
}

/* The colours at point_y, between two of the layers' rows. The last 4 may reach into the room behind the row, or before the
 * mirrored one, that other arrays leave. */
inline void load_colors(const Layers *layers, float point_y, int base, const Row *row, const Row *mirrored)
{
    const int above = (int)point_y, below = min(above + 1, layers->size.y - 1), width = row->width;
    const size_t a = (size_t)above * layers->size.x, b = (size_t)below * layers->size.x;
    const int begin = max(-base, 0), end = min(layers->size.x - base, width);
    for (int j = begin; j < end; j += 4) {
        const int k = width - 4 - j;
        const uint4 seen = blend(layers->color + a, layers->color + b, base + j, point_y - above);
        const uint4 hidden = blend(layers->hidden_color + a, layers->hidden_color + b, base + j, point_y - above);
        *(__global uint4_any *)(row->color + j) = seen;
        *(__global uint4_any *)(row->hidden_color + j) = hidden;
        *(__global uint4_any *)(mirrored->color + k) = seen.s3210;
        *(__global uint4_any *)(mirrored->hidden_color + k) = hidden.s3210;
    }
    repeat_ends(row->color, begin, end, width);
    repeat_ends(row->hidden_color, begin, end, width);
    repeat_ends(mirrored->color, width - end, width - begin, width);
    repeat_ends(mirrored->hidden_color, width - end, width - begin, width);
}

/* The colour between two pixels. */
inline float4 look(const Row *row, __global const uint *picture, float place)
{
    const float inside = clamp(place, 0.0f, row->width - 1.0f);
    const int j = min((int)inside, row->width - 2);
    return mix(convert_float4(as_uchar4(picture[j])), convert_float4(as_uchar4(picture[j + 1])), inside - j);
}

/* What is seen at the place s through the step between j and j + 1, behind the near pixel j: see trace(). `least`: the least
 * height of all. */
inline float4 look_behind(const Row *row, float s, int j, float slope, float step, float least, int fill)
{
    const int end = max((int)(s + slope * least) - 1, 0);
    bool behind = true;
    for (; j >= end; j--) {
        const float place = j - slope * row->height[j];
        if (place > s) {
            behind = false;
            continue;
        }
        behind = behind || (row->height[j] - row->height[j + 1] > step && s - place > TOUCH);
        if (!behind) {
            const float next = j + 1 - slope * row->height[j + 1];
            return look(row, row->color, j + (s - place) / (next - place));
        }
        const float hidden = row->hidden_height[j];
        if (j - slope * hidden <= s || j == end)
            return fill ? look(row, row->hidden_color, s + slope * hidden) : (float4)(0.0f);
    }
    return look(row, row->color, s + slope * least);
}
