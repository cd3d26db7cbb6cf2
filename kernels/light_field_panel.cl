/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Straight to the pixels of a panel that lies under lenses.
 */
#include "light_field_trace.cl"

/* A sheet of slanted cylindrical lenses. With x, y in 0..1 from the panel's bottom left, a byte of a pixel belongs to the
 * view v = fract((x + shift + tilt y) pitch - center), of the slope tan((v - 1/2) cone). shifts: of the first three bytes of
 * two pixels of a row, and so on for four rows from the bottom up. flips: 1 where the picture is mirrored along x, along y, v
 * to 1 - v. */
__kernel void lenticular(LAYERS, float pitch, float tilt, float center, float cone, __global const float *shifts, int4 flips,
                         float2 first, float2 scale, __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= output_size.x)
        return;
    const Layers layers = MAKE_LAYERS;
    const int2 pixel = (int2)(flips.x ? output_size.x - 1 - x : x, flips.y ? output_size.y - 1 - y : y);
    const float2 origin = first + scale * convert_float2(pixel);
    const float from_left = (x + 0.5f) / output_size.x, from_bottom = 1.0f - (y + 0.5f) / output_size.y;
    __global const float *shift = shifts + 6 * (output_size.y - 1 - y & 3) + 3 * (x & 1);
    float value[3];
    for (int c = 0; c < 3; c++) {
        const float place = (from_left + shift[c] + tilt * from_bottom) * pitch - center;
        float view = place - floor(place);
        view = flips.z ? 1.0f - view : view;
        const float4 seen = trace(&layers, origin, (float2)(tan((view - 0.5f) * cone), 0.0f));
        value[c] = c == 0 ? seen.x : c == 1 ? seen.y : seen.z;
    }
    put_color(output + stride * (ulong)y + (ulong)x * channels, channels, (float4)(value[0], value[1], value[2], 255.0f));
}

/* The lens over a point, in units of the pitch along the array's own axes. In a hexagonal grid every second row is shifted by
 * half a lens. */
inline float2 square_lens(float2 p)
{
    return rint(p);
}

inline float2 hexagonal_lens(float2 p)
{
    const float row_height = 0.8660254f; /* sqrt(3) / 2 */
    float2 nearest = 0.0f;
    float least = INFINITY;
    for (int k = 0; k < 2; k++) {
        const float row = floor(p.y / row_height) + k;
        const float shift = 0.5f * (row - 2.0f * floor(0.5f * row));
        const float2 lens = (float2)(rint(p.x - shift) + shift, row * row_height);
        const float distance = dot(p - lens, p - lens);
        if (distance < least) {
            least = distance;
            nearest = lens;
        }
    }
    return nearest;
}

/* A pixel at p behind a lens with its centre in c emits along (c - p) / gap. Points are pixels of the panel; to_lens turns
 * them about `center` and divides by the pitch, to_panel is the way back (rows of 2x2 matrices). flip turns each lens's
 * picture by half a turn. */
__kernel void elemental(LAYERS, float2 center, float4 to_lens, float4 to_panel, float gap, int hexagonal, int flip,
                        float2 first, float2 scale, __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= output_size.x)
        return;
    const Layers layers = MAKE_LAYERS;
    const float2 p = (float2)(x + 0.5f, y + 0.5f) - center;
    const float2 place = (float2)(dot(to_lens.xy, p), dot(to_lens.zw, p));
    const float2 lens = hexagonal ? hexagonal_lens(place) : square_lens(place);
    const float2 c = (float2)(dot(to_panel.xy, lens), dot(to_panel.zw, lens));
    const float2 direction = (flip ? p - c : c - p) / gap;
    const float2 origin = first + scale * (c + center - 0.5f);
    const float4 seen = trace(&layers, origin, direction * (float2)(1.0f, scale.y / scale.x));
    put_color(output + stride * (ulong)y + (ulong)x * channels, channels, seen);
}
