/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as light_field_views.cl, for CPUs: one row of one view a work-item, without a search. The layers' pixel i of
 * height h stands at s = i - slope h in the view, and what lies between it and the next one stands between them. Painted
 * from the left when looking from the right, and the other way round, later pixels are nearer: near surfaces win.
 */
#include "../light_field_trace.cl"

/* A row of a view, in coordinates that run from the right if `mirror` is set, so that the slope is never negative. Beyond
 * its ends the layers' row goes on with its last pixels. */
typedef struct {
    const Layers *layers;
    size_t start;        /* of the row of heights */
    size_t upper, lower; /* of the rows of colours, `share` of the lower one */
    float share, slope;
    int last, mirror;
} Row;

inline size_t index_of(const Row *row, int i)
{
    const int inside = clamp(i, 0, row->last);
    return row->start + (row->mirror ? row->last - inside : inside);
}

inline float place_of(const Row *row, int i)
{
    return i - row->slope * row->layers->height[index_of(row, i)];
}

inline bool is_step(const Row *row, int i)
{
    return row->layers->height[index_of(row, i)] - row->layers->height[index_of(row, i + 1)] > row->layers->step;
}

inline float4 mix_pixels(__global const uchar4 *row, int a, int b, float t)
{
    return mix(convert_float4(row[a]), convert_float4(row[b]), t);
}

/* As color_at(). */
inline float4 look(const Row *row, __global const uchar4 *picture, float s)
{
    const float x = clamp(row->mirror ? row->last - s : s, 0.0f, (float)row->last);
    const int a = (int)x, b = min(a + 1, row->last);
    const float4 upper = mix_pixels(picture + row->upper, a, b, x - a);
    return row->share == 0.0f ? upper : mix(upper, mix_pixels(picture + row->lower, a, b, x - a), row->share);
}

inline int round_up(float value)
{
    const int truncated = (int)value;
    return truncated + (truncated < value);
}

/* What is seen at s through the step between i and i + 1, behind the near pixel i: see trace(). */
inline float4 look_behind(const Row *row, float s, int i)
{
    const Layers *layers = row->layers;
    const int end = (int)floor(s + row->slope * layers->heights.x) - 1;
    bool behind = true;
    for (; i >= end; i--) {
        const float place = place_of(row, i);
        if (place > s) {
            behind = false;
            continue;
        }
        behind = behind || (is_step(row, i) && s - place > TOUCH);
        if (!behind) {
            const float next = place_of(row, i + 1);
            return look(row, layers->color, i + (s - place) / (next - place));
        }
        const float hidden = layers->hidden_height[index_of(row, i)];
        if (i - row->slope * hidden <= s || i == end)
            return layers->fill ? look(row, layers->hidden_color, s + row->slope * hidden) : (float4)(0.0f);
    }
    return look(row, layers->color, s + row->slope * layers->heights.x);
}

/* `width` pixels from s = first on, `scale` apart, to `output`. */
inline void paint(const Row *row, float first, float scale, int width, __global uchar *output, int channels)
{
    const Layers *layers = row->layers;
    const int begin = (int)floor(first + row->slope * layers->heights.x) - 1;
    const int end = (int)ceil(first + scale * (width - 1) + row->slope * layers->heights.y) + 1;
    const float per_layer = 1.0f / scale;
    float place = place_of(row, begin);
    for (int i = begin; i < end; i++) {
        const float next = place_of(row, i + 1);
        const int from = max(round_up((place - first) * per_layer), 0);
        const int to = min(round_up((next - first) * per_layer), width);
        if (from < to) {
            const bool torn = is_step(row, i);
            const float stretch = 1.0f / (next - place);
            for (int x = from; x < to; x++) {
                const float s = first + scale * x;
                const float4 color =
                    torn && s - place > TOUCH ? look_behind(row, s, i) : look(row, layers->color, i + (s - place) * stretch);
                put_color(output + channels * (row->mirror ? width - 1 - x : x), channels, color);
            }
        }
        place = next;
    }
}

/* Arguments as those of views. Work-items (columns, rows of the output). */
__kernel void view_rows(LAYERS, __global const float *slopes, int2 columns_rows, int2 view, float2 first, float2 scale,
                        __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const int column = (int)get_global_id(0), y = (int)get_global_id(1);
    const Layers layers = MAKE_LAYERS;
    const int row_of_views = (output_size.y - 1 - y) / view.y;
    const int end = column + 1 < columns_rows.x ? (column + 1) * view.x : output_size.x;
    __global uchar *line = output + stride * (ulong)y;
    const bool is_left_over = row_of_views >= columns_rows.y;
    for (int x = is_left_over ? column * view.x : (column + 1) * view.x; x < end; x++)
        put_color(line + x * channels, channels, (float4)(0.0f));
    if (is_left_over)
        return;

    const float slope = slopes[row_of_views * columns_rows.x + column];
    const int view_y = view.y - 1 - (output_size.y - 1 - y - row_of_views * view.y);
    const int last = size.x - 1, mirror = slope < 0.0f;
    const float point_y = clamp(first.y + scale.y * view_y, 0.0f, size.y - 1.0f);
    const int above = (int)point_y, below = min(above + 1, size.y - 1);
    const size_t start = (size_t)convert_int_rte(point_y) * size.x;
    /* A view without parallax has no steps to look behind. */
    const bool flat = fabs(slope) * (heights.y - heights.x) < 1e-3f;
    Layers seen = layers;
    seen.step = flat ? INFINITY : step;
    const Row row = {&seen, start, (size_t)above * size.x, (size_t)below * size.x, point_y - above,
                     flat ? 0.0f : fabs(slope), last, mirror};
    const float first_x = mirror ? last - (first.x + scale.x * (view.x - 1)) : first.x;
    paint(&row, first_x, scale.x, view.x, line + column * view.x * channels, channels);
}
