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

inline uint blend(uchar4 a, uchar4 b, float t)
{
    return as_uint(convert_uchar4(mix(convert_float4(a), convert_float4(b), t) + 0.5f));
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

/* The colours at point_y, between two of the layers' rows. */
inline void load_colors(const Layers *layers, float point_y, int base, const Row *row, const Row *mirrored)
{
    const int above = (int)point_y, below = min(above + 1, layers->size.y - 1);
    const size_t a = (size_t)above * layers->size.x, b = (size_t)below * layers->size.x;
    const float share = point_y - above;
    for (int j = 0, k = row->width - 1; j < row->width; j++, k--) {
        const int x = clamp(base + j, 0, layers->size.x - 1);
        uint seen = as_uint(layers->color[a + x]), hidden = as_uint(layers->hidden_color[a + x]);
        if (share > 0.0f) {
            seen = blend(layers->color[a + x], layers->color[b + x], share);
            hidden = blend(layers->hidden_color[a + x], layers->hidden_color[b + x], share);
        }
        row->color[j] = mirrored->color[k] = seen;
        row->hidden_color[j] = mirrored->hidden_color[k] = hidden;
    }
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
