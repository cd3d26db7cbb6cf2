/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as elemental of light_field_panel.cl, for CPUs: 8 rays of neighbours walk in step, see trace(), of which only
 * those that come upon the edge of a thing are traced one by one.
 */
#include "../light_field_trace.cl"
#include "lanes8.cl"

typedef struct {
    float8 x, y;
} Points;

/* See Way. */
typedef struct {
    float8 fall, beside, aside, last_across;
    int8 turn, last_along, stride_along, stride_across, roof_along, roof_across;
} Ways;

inline int8 across_of(const Ways *ways, float8 q)
{
    return convert_int8(clamp(ways->beside + ways->aside * q + 0.5f, (float8)0.0f, ways->last_across));
}

inline int8 along_of(const Ways *ways, int8 u)
{
    return clamp(u ^ ways->turn, (int8)0, ways->last_along);
}

inline float8 heights_at(const Layers *layers, const Ways *ways, int8 u, float8 q)
{
    const int8 pixel = along_of(ways, u) * ways->stride_along + across_of(ways, q) * ways->stride_across;
    return GATHER(float8, layers->height, pixel);
}

/* See roof_over. */
inline float8 roofs_over(const Layers *layers, const Ways *ways, int8 u, float8 q, float8 q_end)
{
    const int8 along = (along_of(ways, u) >> BLOCK_BITS) * ways->roof_along;
    const int8 near = along + (across_of(ways, q) >> BLOCK_BITS) * ways->roof_across;
    const int8 far = along + (across_of(ways, q_end) >> BLOCK_BITS) * ways->roof_across;
    return max(GATHER(float8, layers->roof, near), GATHER(float8, layers->roof, far));
}

/* The channel at `shift` bits between four pixels. */
inline float8 channel_between(uint8 upper_left, uint8 upper_right, uint8 lower_left, uint8 lower_right, float8 right,
                              float8 down, int shift)
{
    const float8 a = channel_of(upper_left, shift), b = channel_of(upper_right, shift);
    const float8 c = channel_of(lower_left, shift), d = channel_of(lower_right, shift);
    const float8 upper = a + (b - a) * right, lower = c + (d - c) * right;
    return upper + (lower - upper) * down;
}

/* Rounded colours between pixels. */
inline uint8 colors_at(__global const uint *picture, int2 size, Points point)
{
    const float8 x = clamp(point.x, 0.0f, size.x - 1.0f), y = clamp(point.y, 0.0f, size.y - 1.0f);
    const int8 left = convert_int8(x), top = convert_int8(y);
    const int8 right = min(left + 1, (int8)(size.x - 1)), upper = top * size.x, lower = min(top + 1, (int8)(size.y - 1)) * size.x;
    const uint8 a = GATHER(uint8, picture, (upper + left)), b = GATHER(uint8, picture, (upper + right));
    const uint8 c = GATHER(uint8, picture, (lower + left)), d = GATHER(uint8, picture, (lower + right));
    const float8 across = x - convert_float8(left), down = y - convert_float8(top);
    uint8 color = OPAQUE;
    for (int shift = 0; shift < 24; shift += 8)
        color |= convert_uint8(convert_int8(channel_between(a, b, c, d, across, down, shift) + 0.5f)) << shift;
    return color;
}

/* The colours, with those of the chosen rays traced one by one. */
inline uint8 trace_chosen(const Layers *layers, Points origin, Points slope, int8 chosen, uint8 colors)
{
    for (int i = 0; i < 8; i++)
        if (EACH(int, chosen)[i]) {
            const float4 color = trace(layers, (float2)(EACH(float, origin.x)[i], EACH(float, origin.y)[i]),
                                       (float2)(EACH(float, slope.x)[i], EACH(float, slope.y)[i]));
            EACH(uint, colors)[i] = as_uint(convert_uchar4(color + 0.5f)) | OPAQUE;
        }
    return colors;
}

/* The rounded colours that 8 rays see. */
inline uint8 trace_all(const Layers *layers, Points origin, Points slope)
{
    const int2 size = layers->size;
    const float least = layers->heights.x, greatest = layers->heights.y;
    const int blocks = BLOCKS(size.x);
    const int8 along_x = fabs(slope.x) >= fabs(slope.y);
    const float8 start = along_x ? origin.x : origin.y, lean_any = along_x ? slope.x : slope.y;
    const int8 upright = fabs(lean_any) * (greatest - least) < 1e-3f;
    const float8 lean = upright ? 1.0f : lean_any;
    const Ways ways = {1.0f / fabs(lean), along_x ? origin.y : origin.x, along_x ? slope.y : slope.x,
                       convert_float8(along_x ? size.y - 1 : size.x - 1), lean > 0.0f, along_x ? size.x - 1 : size.y - 1,
                       along_x ? 1 : size.x, along_x ? size.x : 1, along_x ? 1 : blocks, along_x ? blocks : 1};

    const float8 entry = start + lean * greatest;
    const int8 entered = convert_int8(ways.turn ? ceil(entry) : floor(entry)) ^ ways.turn;
    const int8 first = entered & -BLOCK, last = entered + convert_int8(fabs(lean) * (greatest - least)) + 2;
    const float8 q_first = (convert_float8(first ^ ways.turn) - start) / lean;
    int8 u = first, hit = 0;
    float8 height = 0.0f;
    /* Where rays are next does not depend on what was read, so that the reads of several steps overlap. */
    for (int8 walking = !upright; any(walking);) {
        int8 block = u;
        for (int8 flying = walking; any(flying); u += BLOCK) {
            const float8 q = q_first - convert_float8(u - first) * ways.fall, q_end = q - (BLOCK - 1) * ways.fall;
            flying = flying && u <= last && q_end > roofs_over(layers, &ways, u, q, q_end);
            block = flying ? u + BLOCK : block;
        }
        u = block;
        int8 inside = walking && u <= last, steps = BLOCK;
        for (int step = 0; step < BLOCK && any(inside); step++) {
            const float8 q = q_first - convert_float8(u + step - first) * ways.fall;
            const float8 here = heights_at(layers, &ways, u + step, q);
            const int8 under = inside && q <= here;
            steps = under ? step : steps;
            height = under ? here : height;
            inside = inside && !under;
        }
        u = walking ? u + steps : u;
        hit = hit || (walking && steps < BLOCK);
        walking = walking && !hit && u <= last;
    }

    const float8 q = q_first - convert_float8(u - first) * ways.fall;
    const float8 below = heights_at(layers, &ways, u - 1, q + ways.fall);
    const float8 above = q + ways.fall - below, under = height - q;
    const float8 crossing = hit ? q + ways.fall * under / (above + under) : least;
    const Points place = {origin.x + slope.x * crossing, origin.y + slope.y * crossing};
    const uint8 colors = colors_at((__global const uint *)layers->color, size, place);
    const int8 torn = hit && height - below > layers->step && under * fabs(lean) > TOUCH;
    return any(torn) ? trace_chosen(layers, origin, slope, torn, colors) : colors;
}

/* See hexagonal_lens of light_field_panel.cl. */
inline Points hexagonal_lenses(Points p)
{
    const float row_height = 0.8660254f; /* sqrt(3) / 2 */
    Points nearest = {0.0f, 0.0f};
    float8 least = INFINITY;
    for (int k = 0; k < 2; k++) {
        const float8 row = floor(p.y / row_height) + k;
        const float8 shift = 0.5f * (row - 2.0f * floor(0.5f * row));
        const Points lens = {rint(p.x - shift) + shift, row * row_height};
        const float8 distance = (p.x - lens.x) * (p.x - lens.x) + (p.y - lens.y) * (p.y - lens.y);
        const int8 nearer = distance < least;
        least = nearer ? distance : least;
        nearest.x = nearer ? lens.x : nearest.x;
        nearest.y = nearer ? lens.y : nearest.y;
    }
    return nearest;
}

/* Arguments as those of elemental. Work-items (strips of rows). */
__kernel void elemental_rows(LAYERS, float2 center, float4 to_lens, float4 to_panel, float gap, int hexagonal, int flip,
                             float2 first, float2 scale, __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const Layers layers = MAKE_LAYERS;
    const int strip = (int)get_global_id(0), strips = (int)get_global_size(0);
    const float to_slope = (flip ? -1.0f : 1.0f) / gap, aspect = scale.y / scale.x;
    for (int y = output_size.y * strip / strips; y < output_size.y * (strip + 1) / strips; y++) {
        __global uchar *line = output + stride * (ulong)y;
        for (int x = 0; x < output_size.x; x += 8) {
            const float8 px = LANES8 + (x + 0.5f - center.x);
            const float py = y + 0.5f - center.y;
            const Points place = {to_lens.x * px + to_lens.y * py, to_lens.z * px + to_lens.w * py};
            const Points square = {rint(place.x), rint(place.y)};
            const Points lens = hexagonal ? hexagonal_lenses(place) : square;
            const Points c = {to_panel.x * lens.x + to_panel.y * lens.y, to_panel.z * lens.x + to_panel.w * lens.y};
            const Points slope = {(c.x - px) * to_slope, (c.y - py) * (to_slope * aspect)};
            const Points origin = {first.x + scale.x * (c.x + center.x - 0.5f), first.y + scale.y * (c.y + center.y - 0.5f)};
            put_colors(line, x, min(8, output_size.x - x), channels, trace_all(&layers, origin, slope));
        }
    }
}
