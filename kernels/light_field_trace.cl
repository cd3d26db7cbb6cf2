/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * What a ray sees of the two layers of light_field_layers.cl. A ray crosses the plane of zero parallax in `origin` and
 * leans by `slope` pixels a pixel of height, so that it passes over the pixel x at the height q where
 * x = origin + slope q. It comes from the viewer, from above, and walks pixel by pixel along its longer axis until it is
 * below the surface: near surfaces win, and between two pixels the crossing is found by linear interpolation. Where the
 * surface steps up by more than `step` there is none between the pixels: the ray goes behind the near one and looks at the
 * hidden layer until that stops it or it comes out again; within TOUCH pixels of the near one's place it still meets that.
 * Blocks of pixels that it flies over as a whole, by the roof above them, are left out.
 */
#include "light_field_roof.cl"

#define TOUCH 1e-3f

typedef struct {
    __global const uchar4 *color, *hidden_color;
    __global const float *height, *hidden_height, *roof;
    int2 size;
    float2 heights; /* least and greatest */
    float step;
    int fill; /* 0: what no pixel shows is black */
} Layers;

inline float4 color_at(__global const uchar4 *picture, int2 size, float2 point)
{
    const float2 p = clamp(point, (float2)(0.0f), convert_float2(size - 1));
    const int2 a = convert_int2(p), b = min(a + 1, size - 1);
    const float2 t = p - convert_float2(a);
    __global const uchar4 *upper = picture + (size_t)a.y * size.x, *lower = picture + (size_t)b.y * size.x;
    return mix(mix(convert_float4(upper[a.x]), convert_float4(upper[b.x]), t.x),
               mix(convert_float4(lower[a.x]), convert_float4(lower[b.x]), t.x), t.y);
}

/* The way of a ray over the pixels: at the height q it is over the pixel i = start + lean q of its longer axis. As it falls,
 * u = i ^ turn grows. */
typedef struct {
    float start, lean, beside, aside; /* origin and slope along the longer axis, and across it */
    float fall;                       /* from pixel to pixel */
    int turn;
    int2 strides, roof_strides; /* along and across */
    int last_along;
    float last_across;
} Way;

inline Way make_way(int2 size, float2 origin, float2 slope)
{
    const bool along_x = fabs(slope.x) >= fabs(slope.y);
    const int blocks = BLOCKS(size.x);
    const float lean = along_x ? slope.x : slope.y;
    const Way way = {along_x ? origin.x : origin.y, lean, along_x ? origin.y : origin.x, along_x ? slope.y : slope.x,
                     1.0f / fabs(lean), lean > 0.0f ? -1 : 0, along_x ? (int2)(1, size.x) : (int2)(size.x, 1),
                     along_x ? (int2)(1, blocks) : (int2)(blocks, 1), along_x ? size.x - 1 : size.y - 1,
                     along_x ? size.y - 1 : size.x - 1};
    return way;
}

inline int across_at(const Way *way, float q)
{
    return (int)clamp(way->beside + way->aside * q + 0.5f, 0.0f, way->last_across);
}

inline int along_at(const Way *way, int u)
{
    return clamp(u ^ way->turn, 0, way->last_along);
}

inline int pixel_at(const Way *way, int u, float q)
{
    return along_at(way, u) * way->strides.x + across_at(way, q) * way->strides.y;
}

/* Nothing in the block that begins with u is higher, where the ray falls from q to q_end. */
inline float roof_over(const Layers *layers, const Way *way, int u, float q, float q_end)
{
    __global const float *roof = layers->roof + (along_at(way, u) >> BLOCK_BITS) * way->roof_strides.x;
    return max(roof[(across_at(way, q) >> BLOCK_BITS) * way->roof_strides.y],
               roof[(across_at(way, q_end) >> BLOCK_BITS) * way->roof_strides.y]);
}

/* The pixels between which the ray falls through the relief. */
inline int first_of(const Layers *layers, const Way *way)
{
    const float entry = way->start + way->lean * layers->heights.y;
    return (int)(way->turn ? ceil(entry) : floor(entry)) ^ way->turn;
}

inline int last_of(const Layers *layers, const Way *way)
{
    return first_of(layers, way) + (int)(fabs(way->lean) * (layers->heights.y - layers->heights.x)) + 2;
}

/* The colour that the ray sees, 0..255; nothing stands in its way before the pixel u. */
inline float4 trace_from(const Layers *layers, float2 origin, float2 slope, int u_first)
{
    const Way way = make_way(layers->size, origin, slope);
    const float least = layers->heights.x;
    const int last = last_of(layers, &way);
    bool behind = false;
    for (int block = u_first & -BLOCK; block <= last; block += BLOCK) {
        float q = ((block ^ way.turn) - way.start) / way.lean;
        const float q_end = q - (BLOCK - 1) * way.fall;
        if (q_end > roof_over(layers, &way, block, q, q_end)) {
            behind = false;
            continue;
        }
        const int begin = max(block, u_first);
        q -= (begin - block) * way.fall;
        for (int u = begin; u < block + BLOCK; u++, q -= way.fall) {
            const int pixel = pixel_at(&way, u, q);
            const float height = layers->height[pixel];
            if (q > height) {
                behind = false;
                continue;
            }
            const float below = layers->height[pixel_at(&way, u - 1, q + way.fall)];
            if (behind || (height - below > layers->step && (height - q) * fabs(way.lean) > TOUCH)) {
                behind = true;
                const float hidden = layers->hidden_height[pixel];
                if (q <= hidden || u >= last)
                    return layers->fill ? color_at(layers->hidden_color, layers->size, origin + slope * hidden)
                                        : (float4)(0.0f);
                continue;
            }
            /* The ray was `above` the pixel before and is `under` this one. */
            const float above = q + way.fall - below, under = height - q;
            return color_at(layers->color, layers->size, origin + slope * (q + way.fall * under / (above + under)));
        }
    }
    return color_at(layers->color, layers->size, origin + slope * least);
}

/* The colour that the ray sees, 0..255. */
inline float4 trace(const Layers *layers, float2 origin, float2 slope)
{
    const Way way = make_way(layers->size, origin, slope);
    if (fabs(way.lean) * (layers->heights.y - layers->heights.x) < 1e-3f)
        return color_at(layers->color, layers->size, origin + slope * layers->heights.x);
    return trace_from(layers, origin, slope, first_of(layers, &way));
}

/* Rounds values of 0..255. */
inline void put_color(__global uchar *pixel, int channels, float4 color)
{
    const uchar4 value = convert_uchar4(color + 0.5f);
    if (channels == 4) {
        *(__global uchar4 *)pixel = (uchar4)(value.xyz, 255);
        return;
    }
    pixel[0] = value.x;
    pixel[1] = value.y;
    pixel[2] = value.z;
}

/* The arguments that every kernel takes, and the layers of them. */
#define LAYERS                                                                                                            \
    __global const uchar4 *color, __global const float *height, __global const uchar4 *hidden_color,                       \
        __global const float *hidden_height, __global const float *roof, int2 size, float2 heights, float step, int fill
#define MAKE_LAYERS {color, hidden_color, height, hidden_height, roof, size, heights, step, fill}
