/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as elemental of light_field_panel.cl, for CPUs: the rays of 16 pixels walk in step, see trace(), from where something
 * may stand in the way of any ray through their lens. Only those that come upon the edge of a thing are traced one by one.
 */
#include "../light_field_trace.cl"
#include "lanes16.cl"

typedef struct {
    float16 x, y;
} Points;

/* See Way. */
typedef struct {
    float16 fall, beside, aside, last_across;
    int16 turn, last_along, stride_along, stride_across, roof_along, roof_across;
} Ways;

inline int16 across_of(const Ways *ways, float16 q)
{
    return convert_int16(clamp(ways->beside + ways->aside * q + 0.5f, (float16)0.0f, ways->last_across));
}

inline int16 along_of(const Ways *ways, int16 u)
{
    return clamp(u ^ ways->turn, (int16)0, ways->last_along);
}

inline float16 heights_at(const Layers *layers, const Ways *ways, int16 u, float16 q)
{
    const int16 pixel = along_of(ways, u) * ways->stride_along + across_of(ways, q) * ways->stride_across;
    return GATHER(float16, layers->height, pixel);
}

/* See roof_over. */
inline float16 roofs_over(const Layers *layers, const Ways *ways, int16 u, float16 q, float16 q_end)
{
    const int16 along = (along_of(ways, u) >> BLOCK_BITS) * ways->roof_along;
    const int16 near = along + (across_of(ways, q) >> BLOCK_BITS) * ways->roof_across;
    const int16 far = along + (across_of(ways, q_end) >> BLOCK_BITS) * ways->roof_across;
    return max(GATHER(float16, layers->roof, near), GATHER(float16, layers->roof, far));
}

/* The channel at `shift` bits between four pixels. */
inline float16 channel_between(uint16 upper_left, uint16 upper_right, uint16 lower_left, uint16 lower_right, float16 right,
                              float16 down, int shift)
{
    const float16 a = channel_of(upper_left, shift), b = channel_of(upper_right, shift);
    const float16 c = channel_of(lower_left, shift), d = channel_of(lower_right, shift);
    const float16 upper = a + (b - a) * right, lower = c + (d - c) * right;
    return upper + (lower - upper) * down;
}

/* Rounded colours between pixels. */
INLINE uint16 colors_at(__global const uint *picture, int2 size, Points point)
{
    const float16 x = clamp(point.x, 0.0f, size.x - 1.0f), y = clamp(point.y, 0.0f, size.y - 1.0f);
    const int16 left = convert_int16(x), top = convert_int16(y);
    const int16 right = min(left + 1, (int16)(size.x - 1)), upper = top * size.x;
    const int16 lower = min(top + 1, (int16)(size.y - 1)) * size.x;
    const uint16 a = GATHER(uint16, picture, (upper + left)), b = GATHER(uint16, picture, (upper + right));
    const uint16 c = GATHER(uint16, picture, (lower + left)), d = GATHER(uint16, picture, (lower + right));
    const float16 across = x - convert_float16(left), down = y - convert_float16(top);
    uint16 color = OPAQUE;
    for (int shift = 0; shift < 24; shift += 8)
        color |= convert_uint16(convert_int16(channel_between(a, b, c, d, across, down, shift) + 0.5f)) << shift;
    return color;
}

/* The colours, with those of the chosen rays traced one by one, each from the pixel u. */
inline uint16 trace_chosen(const Layers *layers, Points origin, Points slope, int16 chosen, int16 u, uint16 colors)
{
    for (int i = 0; i < 16; i++)
        if (EACH(int, chosen)[i]) {
            const float4 color = trace_from(layers, (float2)(EACH(float, origin.x)[i], EACH(float, origin.y)[i]),
                                            (float2)(EACH(float, slope.x)[i], EACH(float, slope.y)[i]), EACH(int, u)[i]);
            EACH(uint, colors)[i] = as_uint(convert_uchar4(color + 0.5f)) | OPAQUE;
        }
    return colors;
}

/* All rays through one lens: they cross the plane of zero parallax in `origin`, and lean by at most `reach` along x and y. */
typedef struct {
    float2 origin, reach;
} Lens;

/* The greatest height of the squares, of 1 << bits pixels a side, that rays of the lens pass above as they fall from q to
 * q_end. `roof`: rows of `stride` squares. */
inline float roof_under(__global const float *roof, int stride, int bits, int2 size, const Lens *lens, float q, float q_end)
{
    /* Rays look at the pixel that is nearest across their way. */
    const float2 beside = lens->reach * max(fabs(q), fabs(q_end)) + 0.6f;
    const float2 last_pixel = convert_float2(size - 1);
    const int2 first = convert_int2(clamp(lens->origin - beside, 0.0f, last_pixel)) >> bits;
    const int2 last = convert_int2(clamp(lens->origin + beside, 0.0f, last_pixel)) >> bits;
    float greatest = -INFINITY;
    for (int row = first.y; row <= last.y; row++)
        for (int column = first.x; column <= last.x; column++)
            greatest = max(greatest, roof[row * stride + column]);
    return greatest;
}

/* The height down to which nothing stands in the way of the lens's rays; the least of all if nothing does. */
inline float free_down_to(const Layers *layers, const Lens *lens)
{
    const int2 size = layers->size;
    const float least = layers->heights.x;
    __global const float *groups = layers->roof + BLOCKS(size.x) * BLOCKS(size.y);
    const float fall = BLOCK / max(max(lens->reach.x, lens->reach.y), 1e-3f);
    float q = min(layers->heights.y,
                  roof_under(groups, GROUPS(size.x), BLOCK_BITS + GROUP_BITS, size, lens, layers->heights.y, least));
    while (q > least) {
        const float q_end = max(q - fall, least);
        const float roof = roof_under(layers->roof, BLOCKS(size.x), BLOCK_BITS, size, lens, q, q_end);
        if (roof >= q_end)
            return min(q, roof);
        q = q_end;
    }
    return least;
}

/* 16 rays that cross the plane of zero parallax in `origin`. Nothing stands in their way down to `from`. */
typedef struct {
    Points origin, slope;
    float16 from;
} Rays;

/* The rounded colours that 16 rays see. */
inline uint16 trace_all(const Layers *layers, const Rays *rays)
{
    const int2 size = layers->size;
    const float least = layers->heights.x, greatest = layers->heights.y;
    const Points origin = rays->origin, slope = rays->slope;
    const int blocks = BLOCKS(size.x);
    const int16 along_x = fabs(slope.x) >= fabs(slope.y);
    const float16 start = along_x ? origin.x : origin.y, lean_any = along_x ? slope.x : slope.y;
    const int16 upright = fabs(lean_any) * (greatest - least) < 1e-3f;
    const float16 lean = upright ? 1.0f : lean_any;
    const Ways ways = {1.0f / fabs(lean), along_x ? origin.y : origin.x, along_x ? slope.y : slope.x,
                       convert_float16(along_x ? size.y - 1 : size.x - 1), lean > 0.0f, along_x ? size.x - 1 : size.y - 1,
                       along_x ? 1 : size.x, along_x ? size.x : 1, along_x ? 1 : blocks, along_x ? blocks : 1};

    const float16 entry = start + lean * rays->from;
    const int16 first = convert_int16(ways.turn ? ceil(entry) : floor(entry)) ^ ways.turn;
    const int16 last = first + convert_int16(fabs(lean) * (rays->from - least)) + 2;
    const float16 q_first = (convert_float16(first ^ ways.turn) - start) / lean;
    int16 u = first, hit = 0;
    float16 height = 0.0f;
    /* Where rays are next does not depend on what was read, so that the reads of several steps overlap. */
    for (int16 walking = !upright; any_of(walking);) {
        int16 inside = walking && u <= last, steps = BLOCK;
        for (int step = 0; step < BLOCK && any_of(inside); step++) {
            const float16 q = q_first - convert_float16(u + step - first) * ways.fall;
            const float16 here = heights_at(layers, &ways, u + step, q);
            const int16 under = inside && q <= here;
            steps = under ? step : steps;
            height = under ? here : height;
            inside = inside && !under;
        }
        u = walking ? u + steps : u;
        hit = hit || (walking && steps < BLOCK);
        walking = walking && !hit && u <= last;
        if (!any_of(walking))
            break;
        /* What passes an edge flies on over blocks, from the one that it is in. */
        u = walking ? max(u & -BLOCK, first) : u;
        int16 block = u;
        for (int16 flying = walking; any_of(flying); u = (u & -BLOCK) + BLOCK) {
            const float16 q = q_first - convert_float16(u - first) * ways.fall, q_end = q - (BLOCK - 1) * ways.fall;
            flying = flying && u <= last && q_end > roofs_over(layers, &ways, u, q, q_end);
            block = flying ? (u & -BLOCK) + BLOCK : block;
        }
        u = block;
    }

    const float16 q = q_first - convert_float16(u - first) * ways.fall;
    const float16 below = heights_at(layers, &ways, u - 1, q + ways.fall);
    const float16 above = q + ways.fall - below, under = height - q;
    const float16 crossing = hit ? q + ways.fall * under / (above + under) : least;
    const Points place = {origin.x + slope.x * crossing, origin.y + slope.y * crossing};
    const uint16 colors = colors_at((__global const uint *)layers->color, size, place);
    const int16 torn = hit && height - below > layers->step && under * fabs(lean) > TOUCH;
    return any_of(torn) ? trace_chosen(layers, origin, slope, torn, u, colors) : colors;
}

/* See hexagonal_lens of light_field_panel.cl. */
inline Points hexagonal_lenses(Points p)
{
    const float row_height = 0.8660254f; /* sqrt(3) / 2 */
    Points nearest = {0.0f, 0.0f};
    float16 least = INFINITY;
    for (int k = 0; k < 2; k++) {
        const float16 row = floor(p.y / row_height) + k;
        const float16 shift = 0.5f * (row - 2.0f * floor(0.5f * row));
        const Points lens = {rint(p.x - shift) + shift, row * row_height};
        const float16 distance = (p.x - lens.x) * (p.x - lens.x) + (p.y - lens.y) * (p.y - lens.y);
        const int16 nearer = distance < least;
        least = nearer ? distance : least;
        nearest.x = nearer ? lens.x : nearest.x;
        nearest.y = nearer ? lens.y : nearest.y;
    }
    return nearest;
}

/* The middles of the lenses over points of the panel, both from the array's middle. */
inline Points lenses_over(Points p, float4 to_lens, float4 to_panel, int hexagonal)
{
    const Points place = {to_lens.x * p.x + to_lens.y * p.y, to_lens.z * p.x + to_lens.w * p.y};
    const Points square = {rint(place.x), rint(place.y)};
    const Points lens = hexagonal ? hexagonal_lenses(place) : square;
    const Points middle = {to_panel.x * lens.x + to_panel.y * lens.y, to_panel.z * lens.x + to_panel.w * lens.y};
    return middle;
}

/* How far from a lens's middle its pixels are at most along x and y, pixels of the panel. */
inline float2 half_size(float4 to_panel, int hexagonal)
{
    const float half_height = hexagonal ? 0.57735027f : 0.5f; /* 1 / sqrt(3) */
    const float4 sides = fabs(to_panel);
    return 0.5f * sides.even + half_height * sides.odd;
}

/* The lenses over 16 pixels of the panel and down to where their rays are free. */
typedef struct {
    Points middle;
    float16 from;
} Lenses;

/* Finds `from` for the lenses with these middles, where they are others than those over the row before. `origin`: where
 * their rays cross the plane of zero parallax. */
inline void find_free(const Layers *layers, Points middle, Points origin, float2 reach, Lenses *lenses)
{
    for (int i = 0; i < 16; i++) {
        const float x = EACH(const float, middle.x)[i], y = EACH(const float, middle.y)[i];
        if (EACH(const float, lenses->middle.x)[i] == x && EACH(const float, lenses->middle.y)[i] == y)
            continue;
        const Lens lens = {(float2)(EACH(const float, origin.x)[i], EACH(const float, origin.y)[i]), reach};
        const bool again = i > 0 && EACH(const float, middle.x)[i - 1] == x && EACH(const float, middle.y)[i - 1] == y;
        EACH(float, lenses->from)[i] = again ? EACH(const float, lenses->from)[i - 1] : free_down_to(layers, &lens);
    }
    lenses->middle = middle;
}

#define SECTION 16 /* times 16 pixels of a row */

/* Arguments as those of elemental. Work-items (strips of rows). */
__kernel void elemental_rows(LAYERS, float2 center, float4 to_lens, float4 to_panel, float gap, int hexagonal, int flip,
                             float2 first, float2 scale, __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const Layers layers = MAKE_LAYERS;
    const int strip = (int)get_global_id(0), strips = (int)get_global_size(0);
    const float2 to_slope = (float2)(1.0f, scale.y / scale.x) * (flip ? -1.0f : 1.0f) / gap;
    const float2 reach = half_size(to_panel, hexagonal) * fabs(to_slope);
    Lenses lenses[SECTION];
    /* Neighbours in a section look at the same part of the relief, row after row. */
    for (int section = 0; section < output_size.x; section += 16 * SECTION) {
        for (int i = 0; i < SECTION; i++)
            lenses[i].middle.x = INFINITY;
        for (int y = output_size.y * strip / strips; y < output_size.y * (strip + 1) / strips; y++) {
            __global uchar *line = output + stride * (ulong)y;
            for (int i = 0; i < SECTION && section + 16 * i < output_size.x; i++) {
                const int x = section + 16 * i;
                const Points p = {min(LANES16 + (float)x, output_size.x - 1.0f) + 0.5f - center.x, y + 0.5f - center.y};
                const Points middle = lenses_over(p, to_lens, to_panel, hexagonal);
                const Points origin = {first.x + scale.x * (middle.x + center.x - 0.5f),
                                       first.y + scale.y * (middle.y + center.y - 0.5f)};
                if (any_of(middle.x != lenses[i].middle.x || middle.y != lenses[i].middle.y))
                    find_free(&layers, middle, origin, reach, &lenses[i]);
                const Rays rays = {origin, {(middle.x - p.x) * to_slope.x, (middle.y - p.y) * to_slope.y}, lenses[i].from};
                put_colors(line, x, min(16, output_size.x - x), channels, trace_all(&layers, &rays));
            }
        }
    }
}
