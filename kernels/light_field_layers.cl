/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * A colour picture and its depth map as two layers of a relief: the surface that is seen, and what it hides.
 *
 * The height of a pixel is how far it stands before the plane of zero parallax, in pixels of the layers: a view from
 * the slope t = tan(angle) shows it shifted by -t height. height = range (zero - u), with u = 0 the near and 1 the far
 * end of the sweep.
 */

/* The mean colour of the source pixels that a pixel covers. channels: bytes a pixel of the source, 3 or 4. columns: the first
 * of the layers' that are needed, and the one behind the last. Work-items (columns, rows). */
__kernel void shrink_color(__global const uchar *source, ulong stride, int channels, int2 source_size,
                           __global uchar4 *color, int2 size, int2 columns)
{
    const int x = columns.x + (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= columns.y)
        return;
    const float2 scale = convert_float2(source_size) / convert_float2(size);
    const float left = x * scale.x, right = left + scale.x, top = y * scale.y, bottom = top + scale.y;
    float3 sum = 0.0f;
    float weights = 0.0f;
    for (int j = (int)top; j < min((int)ceil(bottom), source_size.y); j++)
        for (int i = (int)left; i < min((int)ceil(right), source_size.x); i++) {
            const float weight = (min(right, i + 1.0f) - max(left, (float)i)) * (min(bottom, j + 1.0f) - max(top, (float)j));
            __global const uchar *pixel = source + stride * (ulong)j + (ulong)(i * channels);
            sum += weight * (float3)(pixel[0], pixel[1], pixel[2]);
            weights += weight;
        }
    color[(size_t)y * size.x + x] = (uchar4)(convert_uchar3_sat_rte(sum / weights), 255);
}

/* The height of the source pixel in the middle of each pixel; NAN where it has no depth. positions: u by depth pixel. */
__kernel void height_of_depth(__global const uchar *depth, ulong stride, __global const float *positions,
                              int2 source_size, __global float *height, int2 size, int2 columns, float zero, float range)
{
    const int x = columns.x + (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= columns.y)
        return;
    const int i = min((int)((x + 0.5f) * source_size.x / size.x), source_size.x - 1);
    const int j = min((int)((y + 0.5f) * source_size.y / size.y), source_size.y - 1);
    const ushort pixel = *(__global const ushort *)(depth + stride * (ulong)j + 2ul * i);
    height[(size_t)y * size.x + x] = range * (zero - positions[pixel]);
}

/* Gives pixels without a height the lower, farther one of their known neighbours in the row. A row without any lies in the
 * plane of zero parallax. Work-items (rows). */
__kernel void fill_unknown(__global float *height, int stride, int2 columns)
{
    __global float *row = height + (size_t)get_global_id(0) * stride + columns.x;
    const int width = columns.y - columns.x;
    int x = 0;
    while (x < width) {
        if (!isnan(row[x])) {
            x++;
            continue;
        }
        const int first = x;
        while (x < width && isnan(row[x]))
            x++;
        float fill = x < width ? row[x] : 0.0f;
        if (first > 0)
            fill = x < width ? min(fill, row[first - 1]) : row[first - 1];
        for (int i = first; i < x; i++)
            row[i] = fill;
    }
}

/* The last pixel of the ground beside a step up that hides `x`, walking along `direction`; -1 if nothing is hidden. `ground`
 * is that of the pixel before. Hidden is what a step of more than `step` covers, up to `reach` pixels behind its edge. */
inline int walk(__global const float *row, int x, int direction, int ground, float step, int reach)
{
    if (row[x] > row[x - direction] + step)
        ground = x - direction;
    const bool over = ground < 0 || row[x] <= row[ground] + step || abs(x - ground) > reach;
    return over ? -1 : ground;
}

/* The ground's texture goes on behind its edge as in a mirror, as far as it is of the same height. */
inline int mirrored(__global const float *row, int width, int x, int ground, float step)
{
    const int i = 2 * ground - x + (x > ground ? 1 : -1);
    return i >= 0 && i < width && fabs(row[i] - row[ground]) <= step ? i : ground;
}

typedef int16 __attribute__((aligned(4))) int16_any;
typedef float16 __attribute__((aligned(4))) float16_any;

/* Of 16 pixels from `row` on, none is a step up from its neighbour on the side of -direction. */
inline bool no_steps(__global const float *row, int direction, float step)
{
    return !any_of(*(__global const float16_any *)row > *(__global const float16_any *)(row - direction) + step);
}

/* What the grounds `left` and `right` of the pixel x, or one of them, show behind it. */
inline void put_hidden(__global const uchar4 *color, __global const float *height, __global uchar4 *hidden_color,
                       __global float *hidden_height, int width, int x, int left, int right, float step)
{
    const float from_left = left < 0 ? 0.0f : right < 0 ? 1.0f : (float)(right - x) / (right - left);
    const int a = left < 0 ? right : left, b = right < 0 ? left : right;
    const float4 left_color = convert_float4(color[mirrored(height, width, x, a, step)]);
    const float4 right_color = convert_float4(color[mirrored(height, width, x, b, step)]);
    hidden_color[x] = convert_uchar4(mix(right_color, left_color, from_left) + 0.5f);
    hidden_height[x] = mix(height[b], height[a], from_left);
}

/* The hidden layer: where a pixel stands before lower ones, these continued behind it; elsewhere the seen layer. Between
 * two grounds the lower is taken, and near the middle of equal ones both are mixed. 16 pixels without a step and far from
 * any are done at once. Work-items (rows); grounds: an int a pixel. */
__kernel void hide(__global const uchar4 *color, __global const float *height, __global uchar4 *hidden_color,
                   __global float *hidden_height, __global int *grounds, int stride, int2 columns, float step, int reach)
{
    const size_t start = (size_t)get_global_id(0) * stride + columns.x;
    const int width = columns.y - columns.x;
    color += start, height += start, hidden_color += start, hidden_height += start, grounds += start;
    grounds[width - 1] = -1;
    for (int x = width - 2, ground = -1; x >= 0;) {
        if (ground < 0 && x >= 15 && no_steps(height + x - 15, -1, step)) {
            *(__global int16_any *)(grounds + x - 15) = -1;
            x -= 16;
            continue;
        }
        for (const int end = max(x - 16, -1); x > end; x--)
            grounds[x] = ground = walk(height, x, -1, ground, step, reach);
    }

    for (int x = 0, left = -1; x < width;) {
        if (left < 0 && x > 0 && x + 16 <= width && !any_of(*(__global const int16_any *)(grounds + x) >= 0) &&
            no_steps(height + x, 1, step)) {
            *(__global int16_any *)(hidden_color + x) = *(__global const int16_any *)(color + x);
            *(__global float16_any *)(hidden_height + x) = *(__global const float16_any *)(height + x);
            x += 16;
            continue;
        }
        for (const int end = min(x + 16, width); x < end; x++) {
            left = x > 0 ? walk(height, x, 1, left, step, reach) : -1;
            int right = grounds[x];
            if (left >= 0 && right >= 0 && fabs(height[left] - height[right]) > step) {
                if (height[left] < height[right])
                    right = -1;
                else
                    left = -1;
            }
            if (left >= 0 || right >= 0) {
                put_hidden(color, height, hidden_color, hidden_height, width, x, left, right, step);
            } else {
                hidden_color[x] = color[x];
                hidden_height[x] = height[x];
            }
        }
    }
}
