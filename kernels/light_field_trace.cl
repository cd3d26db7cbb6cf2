/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * What a ray sees of the two layers of light_field_layers.cl. A ray crosses the plane of zero parallax in `origin` and
 * leans by `slope` pixels a pixel of height, so that it passes over the pixel x at the height q where
 * x = origin + slope q. It comes from the viewer, from above, and walks pixel by pixel along its longer axis until it is
 * below the surface: near surfaces win, and between two pixels the crossing is found by linear interpolation. Where the
 * surface steps up by more than `step` there is none between the pixels: the ray goes behind the near one and looks at the
 * hidden layer until that stops it or it comes out again; within TOUCH pixels of the near one's place it still meets that.
 */
#define TOUCH 1e-3f

typedef struct {
    __global const uchar4 *color, *hidden_color;
    __global const float *height, *hidden_height;
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

/* The colour that the ray sees, 0..255. */
inline float4 trace(const Layers *layers, float2 origin, float2 slope)
{
    const bool along_x = fabs(slope.x) >= fabs(slope.y);
    const float lean = along_x ? slope.x : slope.y, start = along_x ? origin.x : origin.y;
    const float least = layers->heights.x, greatest = layers->heights.y;
    if (fabs(lean) * (greatest - least) < 1e-3f)
        return color_at(layers->color, layers->size, origin + slope * least);

    const int direction = lean > 0.0f ? -1 : 1;
    const float entry = start + lean * greatest;
    const int first = direction < 0 ? (int)ceil(entry) : (int)floor(entry);
    const int steps = (int)(fabs(lean) * (greatest - least)) + 2;
    const float fall = 1.0f / fabs(lean); /* of the ray, a pixel */
    const int stride = layers->size.x, last_along = (along_x ? layers->size.x : layers->size.y) - 1;
    const float last_across = (along_x ? layers->size.y : layers->size.x) - 1;
    const float beside = along_x ? origin.y : origin.x, aside = along_x ? slope.y : slope.x;

    float q = (first - start) / lean, below = -INFINITY;
    bool behind = false;
    for (int k = 0; k <= steps; k++, q -= fall) {
        const int along = clamp(first + direction * k, 0, last_along);
        const int across = (int)clamp(beside + aside * q + 0.5f, 0.0f, last_across);
        const size_t i = along_x ? (size_t)across * stride + along : (size_t)along * stride + across;
        const float height = layers->height[i];
        if (q > height) {
            behind = false;
        } else if (behind || (k > 0 && height - below > layers->step && (height - q) * fabs(lean) > TOUCH)) {
            behind = true;
            if (q <= layers->hidden_height[i] || k == steps)
                return layers->fill ? color_at(layers->hidden_color, layers->size, origin + slope * layers->hidden_height[i])
                                    : (float4)(0.0f);
        } else {
            /* The ray was `above` the pixel before and is `under` this one. */
            const float above = q + fall - below, under = height - q;
            const float crossing = k > 0 ? q + fall * under / (above + under) : q;
            return color_at(layers->color, layers->size, origin + slope * crossing);
        }
        below = height;
    }
    return color_at(layers->color, layers->size, origin + slope * least);
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
        __global const float *hidden_height, int2 size, float2 heights, float step, int fill
#define MAKE_LAYERS {color, hidden_color, height, hidden_height, size, heights, step, fill}
