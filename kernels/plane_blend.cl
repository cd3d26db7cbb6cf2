/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Included by joint_upsampling.cl: the colours a stack shows at a position u between its planes, a small square of pixels
 * at a time,
 *
 *     G(p) = sum_z w_z I_z(p) / sum_z w_z,  w_z = exp(-(z - u)^2 / (2 s^2)),  s = 0.6 + 0.3 t,  |z - u| <= 2.5 s,
 *
 * in DN, red, green and blue (all the same where there is no colour); t says how strong the noise is, see noise.cl. A
 * square of SCALE x SCALE pixels is one such part, at SCALE 8 four. LANES = pixels of a part, EDGE = its side.
 */
#include "low_picture.cl"

#if LUMA_BYTES == 2
#define SAMPLE ushort
#define SAMPLES(n) ushort##n
#define SAMPLES_ANYWHERE lanes16
#define DN_A_SAMPLE (255.0f / 65535.0f)
#else
#define SAMPLE uchar
#define SAMPLES(n) uchar##n
#define SAMPLES_ANYWHERE lanes8
#define DN_A_SAMPLE 1.0f
#endif

#if SCALE == 2
#define EDGE 2
typedef float4 lanes;
typedef float2 pixels;
typedef SAMPLES(2) __attribute__((aligned(LUMA_BYTES))) samples_anywhere;
typedef ushort2 __attribute__((aligned(2))) codes_anywhere;
#define CONVERT_PIXELS convert_float2
#define LOAD_PIXELS(p) vload2(0, p)
#define STORE_LANES(v, p) vstore4(v, 0, p)
#define CONVERT_CODES(v) convert_ushort2(convert_int2(v))
#define JOIN(rows) (lanes)(rows[0], rows[1])
#define DOUBLE(v) (lanes)(v[0])
#else
#define EDGE 4
typedef float16 lanes;
typedef float4 pixels;
typedef SAMPLES(4) __attribute__((aligned(LUMA_BYTES))) samples_anywhere;
typedef ushort4 __attribute__((aligned(2))) codes_anywhere;
#define CONVERT_PIXELS convert_float4
#define LOAD_PIXELS(p) vload4(0, p)
#define STORE_LANES(v, p) vstore16(v, 0, p)
#define CONVERT_CODES(v) convert_ushort4(convert_int4(v))
#define JOIN(rows) (lanes)(rows[0], rows[1], rows[2], rows[3])
#define DOUBLE(v)                                                                                                      \
    (lanes)(v[0], v[0], v[1], v[1], v[0], v[0], v[1], v[1], v[2], v[2], v[3], v[3], v[2], v[2], v[3], v[3])
#endif
#define LANES (EDGE * EDGE)

#define PARTS (SCALE * SCALE / LANES)

typedef struct {
    __global const uchar *stack;
    __global const ulong2 *table;
    int4 channels; /* see colour_channels() in luma.h */
    int planes;
    int width;
    int height;
} Stack;

typedef struct {
    lanes red, green, blue;
} Colours;

#if defined(CHROMA)
/* As small_planes.cl. */
INLINE void to_rgb(Colours *colours)
{
    const lanes y = colours->red, u = colours->green - 128.0f, v = colours->blue - 128.0f;
    colours->red = y + (45.0f / 32) * v;
    colours->green = y - (11.0f / 32) * u - (23.0f / 32) * v;
    colours->blue = y + (57.0f / 32) * u;
}
#endif

/* Weighs the planes of G at the position u: from first to last, exp(-(z - u)^2 / (2 s^2)) each. */
typedef struct {
    int first, last;
    float u, steepness;
} Blend;

INLINE Blend blend_at(float u, float t, int planes)
{
    const float s = 0.6f + 0.3f * t, reach = 2.5f * s;
    const Blend blend = {max((int)ceil(u - reach), 0), min((int)(u + reach), planes - 1), u, -1.0f / (2.0f * s * s)};
    return blend;
}

INLINE float plane_weight(const Blend *blend, int z)
{
    const float distance = z - blend->u;
    return native_exp(blend->steepness * distance * distance);
}

/* G of a part that may lie partly outside. */
INLINE Colours blend_any_part(const Stack *stack, const Blend *blend, int left, int top)
{
    float sums[3][LANES], weights = 0.0f;
    for (int lane = 0; lane < LANES; lane++)
        sums[0][lane] = sums[1][lane] = sums[2][lane] = 0.0f;
    for (int z = blend->first; z <= blend->last; z++) {
        const float weight = plane_weight(blend, z);
        const ulong2 rows = stack->table[z];
        for (int lane = 0; lane < LANES; lane++) {
            const int x = clamp(left + lane % EDGE, 0, stack->width - 1), y = clamp(top + lane / EDGE, 0, stack->height - 1);
#if defined(INTERLEAVED)
            __global const uchar *row = stack->stack + rows.x + rows.y * (ulong)y;
            sums[0][lane] += weight * dn_of(row, x * CHANNELS + stack->channels.s1);
            sums[1][lane] += weight * dn_of(row, x * CHANNELS + stack->channels.s2);
            sums[2][lane] += weight * dn_of(row, x * CHANNELS + stack->channels.s3);
#else
            sums[0][lane] += weight * luma_at(stack->stack, rows, x, y);
#if defined(CHROMA)
            const ulong2 u_rows = stack->table[stack->planes + z], v_rows = stack->table[V_COMPONENT * stack->planes + z];
            sums[1][lane] += weight * stack->stack[u_rows.x + u_rows.y * (ulong)(y / 2) + x / 2 * stack->channels.s0 +
                                                   stack->channels.s1];
            sums[2][lane] += weight * stack->stack[v_rows.x + v_rows.y * (ulong)(y / 2) + x / 2 * stack->channels.s2 +
                                                   stack->channels.s3];
#endif
#endif
        }
        weights += weight;
    }
    Colours colours;
    lanes *colour[3] = {&colours.red, &colours.green, &colours.blue};
    for (int i = 0; i < 3; i++) {
        pixels rows[EDGE];
        for (int j = 0; j < EDGE; j++)
            rows[j] = LOAD_PIXELS(sums[i] + j * EDGE) / weights;
        *colour[i] = JOIN(rows);
    }
#if defined(CHROMA)
    to_rgb(&colours);
#elif !defined(INTERLEAVED)
    colours.green = colours.blue = colours.red;
#endif
    return colours;
}

#define READ_PIXELS(pointer) CONVERT_PIXELS(*(__global const samples_anywhere *)(pointer))

/* The same of a part inside. */
INLINE Colours blend_part(const Stack *stack, const Blend *blend, int left, int top)
{
    pixels red[EDGE], green[EDGE], blue[EDGE];
    float u[LANES / 4], v[LANES / 4], weights = 0.0f;
    UNROLL
    for (int j = 0; j < EDGE; j++)
        red[j] = green[j] = blue[j] = 0.0f;
    UNROLL
    for (int i = 0; i < LANES / 4; i++)
        u[i] = v[i] = 0.0f;
    for (int z = blend->first; z <= blend->last; z++) {
        const float weight = plane_weight(blend, z);
        const ulong2 rows = stack->table[z];
        weights += weight;
        UNROLL
        for (int j = 0; j < EDGE; j++) {
            __global const SAMPLE *row = (__global const SAMPLE *)(stack->stack + rows.x + rows.y * (ulong)(top + j));
#if defined(INTERLEAVED)
#if EDGE == 4 && CHANNELS == 4
            const SAMPLES(16) all = *(__global const SAMPLES_ANYWHERE *)(row + 4 * left);
            const SAMPLES(4) first = all.s048c, second = all.s159d, third = all.s26ae;
#elif EDGE == 4
            __global const samples_anywhere *quads = (__global const samples_anywhere *)(row + 3 * left);
            const SAMPLES(4) a = quads[0], b = quads[1], c = quads[2];
            const SAMPLES(4) first = (SAMPLES(4))(a.s03, b.s2, c.s1), second = (SAMPLES(4))(a.s1, b.s03, c.s2),
                             third = (SAMPLES(4))(a.s2, b.s1, c.s03);
#else
            __global const SAMPLE *pixel = row + CHANNELS * left;
            const SAMPLES(2) first = (SAMPLES(2))(pixel[0], pixel[CHANNELS]),
                             second = (SAMPLES(2))(pixel[1], pixel[CHANNELS + 1]),
                             third = (SAMPLES(2))(pixel[2], pixel[CHANNELS + 2]);
#endif
            red[j] += weight * CONVERT_PIXELS(first);
            green[j] += weight * CONVERT_PIXELS(second);
            blue[j] += weight * CONVERT_PIXELS(third);
#else
            red[j] += weight * READ_PIXELS(row + left);
#endif
        }
#if defined(CHROMA)
        const ulong2 u_rows = stack->table[stack->planes + z], v_rows = stack->table[V_COMPONENT * stack->planes + z];
        UNROLL
        for (int i = 0; i < LANES / 4; i++) {
            const int x = left / 2 + i % (EDGE / 2), y = top / 2 + i / (EDGE / 2);
            u[i] += weight *
                    stack->stack[u_rows.x + u_rows.y * (ulong)y + x * stack->channels.s0 + stack->channels.s1];
            v[i] += weight *
                    stack->stack[v_rows.x + v_rows.y * (ulong)y + x * stack->channels.s2 + stack->channels.s3];
        }
#endif
    }
    const float scale = DN_A_SAMPLE / weights;
    Colours colours;
#if defined(INTERLEAVED)
    const int blue_first = stack->channels.s1 == 2;
    const lanes first = JOIN(red) * scale, third = JOIN(blue) * scale;
    colours.red = blue_first ? third : first;
    colours.green = JOIN(green) * scale;
    colours.blue = blue_first ? first : third;
#else
    colours.red = colours.green = colours.blue = JOIN(red) * scale;
#if defined(CHROMA)
    colours.green = DOUBLE(u) * scale;
    colours.blue = DOUBLE(v) * scale;
    to_rgb(&colours);
#endif
#endif
    return colours;
}
