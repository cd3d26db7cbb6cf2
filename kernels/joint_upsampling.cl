/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * u at full resolution from the low u (Kopf et al. 2007): the mean of the 4x4 low cells around a pixel, weighted by
 *
 *     max(0, 1 - |G(p) - A(q)|_1 / 60)^2 exp(-d^2 / (2 1.5^2)) + 1e-5,  d in low cells,
 *
 * where these cells differ by half a plane or more, bilinear elsewhere. A is the guide at the final u, and G its like at
 * full resolution: the planes blended at the nearer u around the pixel. Only pixels near depth edges need G.
 *
 * All pixels between four low cells have the same 4x4 cells: such a square of SCALE x SCALE pixels is worked on at
 * once (at SCALE 8 in four parts). LANES = pixels of a part, EDGE = its side.
 */
#include "low_picture.cl"

#if SCALE == 2
#define EDGE 2
typedef float4 lanes;
#define LOAD_LANES(p) vload4(0, p)
#define STORE_LANES(v, p) vstore4(v, 0, p)
#else
#define EDGE 4
typedef float16 lanes;
#define LOAD_LANES(p) vload16(0, p)
#define STORE_LANES(v, p) vstore16(v, 0, p)
#endif
#define LANES (EDGE * EDGE)

#define PARTS (SCALE * SCALE / LANES)

#define SAME_DEPTH 0.5f /* planes */
#define TOLERANCE 60.0f /* DN, the three colours together */

typedef struct {
    __global const uchar *stack;
    __global const ulong2 *table;
    int4 channels; /* interleaved: bytes a pixel, index of R, G, B; NV12 and I420: step and index of U, of V */
    int planes;
    int width;
    int height;
} Stack;

/* Adds the pixels of a part, weighted, to three colours, which colours_of() makes R, G, B. */
INLINE void add_pixels(const Stack *stack, int z, int left, int top, float weight, float *red, float *green,
                       float *blue)
{
    const ulong2 rows = stack->table[z];
    UNROLL
    for (int j = 0; j < EDGE; j++) {
        const int y = clamp(top + j, 0, stack->height - 1);
        __global const uchar *row = stack->stack + rows.x + rows.y * (ulong)y;
#ifdef CHROMA
        const ulong2 u_rows = stack->table[stack->planes + z], v_rows = stack->table[V_COMPONENT * stack->planes + z];
        __global const uchar *u_row = stack->stack + u_rows.x + u_rows.y * (ulong)(y / 2);
        __global const uchar *v_row = stack->stack + v_rows.x + v_rows.y * (ulong)(y / 2);
#endif
        UNROLL
        for (int i = 0; i < EDGE; i++) {
            const int x = clamp(left + i, 0, stack->width - 1), lane = j * EDGE + i;
#if defined(INTERLEAVED)
            __global const uchar *pixel = row + x * stack->channels.s0;
            red[lane] += weight * pixel[stack->channels.s1];
            green[lane] += weight * pixel[stack->channels.s2];
            blue[lane] += weight * pixel[stack->channels.s3];
#else
            red[lane] += weight * luma_at(row, (ulong2)(0), x, 0);
#if defined(CHROMA)
            green[lane] += weight * u_row[x / 2 * stack->channels.s0 + stack->channels.s1];
            blue[lane] += weight * v_row[x / 2 * stack->channels.s2 + stack->channels.s3];
#endif
#endif
        }
    }
}

/* As colours_of_yuv of small_planes.cl. */
INLINE void colours_of(lanes *red, lanes *green, lanes *blue)
{
#if defined(CHROMA)
    const lanes y = *red, u = *green - 128.0f, v = *blue - 128.0f;
    *red = y + 1.402f * v;
    *green = y - 0.344f * u - 0.714f * v;
    *blue = y + 1.772f * u;
#elif !defined(INTERLEAVED)
    *green = *blue = *red;
#endif
}

/* Depth pixels of positions u: see depth_code.cl. */
INLINE void write_depth(__global ushort *depth, const float *u, __global const ushort *codes, int is_linear, int left,
                        int top, int planes, int width, int height)
{
    const lanes share = clamp(LOAD_LANES(u) * (1.0f / (planes - 1)), 0.0f, 1.0f);
    float numbers[LANES];
    STORE_LANES(share * 65534.0f + 1.5f, numbers);
    for (int j = max(-top, 0); j < min(EDGE, height - top); j++)
        for (int i = max(-left, 0); i < min(EDGE, width - left); i++) {
            const ushort number = (ushort)(int)numbers[j * EDGE + i];
            depth[(size_t)(top + j) * width + left + i] = is_linear ? number : codes[number];
        }
}

/* Where the pixels of each part lie between the cells, in low cells, and their nearness to each of the 4x4. */
typedef struct {
    lanes across[PARTS];
    lanes down[PARTS];
    lanes nearness[PARTS][16];
} Places;

INLINE void find_places(Places *places)
{
    for (int part = 0; part < PARTS; part++) {
        float across[LANES], down[LANES], nearness[LANES];
        for (int lane = 0; lane < LANES; lane++) {
            across[lane] = (part % (SCALE / EDGE) * EDGE + lane % EDGE + 0.5f) / SCALE;
            down[lane] = (part / (SCALE / EDGE) * EDGE + lane / EDGE + 0.5f) / SCALE;
        }
        places->across[part] = LOAD_LANES(across);
        places->down[part] = LOAD_LANES(down);
        UNROLL
        for (int k = 0; k < 16; k++) {
            for (int lane = 0; lane < LANES; lane++) {
                const float dx = across[lane] - (k % 4 - 1.0f), dy = down[lane] - (k / 4 - 1.0f);
                nearness[lane] = native_exp((dx * dx + dy * dy) * (-1.0f / 4.5f));
            }
            places->nearness[part][k] = LOAD_LANES(nearness);
        }
    }
}

INLINE float spread(const float *cells)
{
    const float16 all = vload16(0, cells);
    const float8 low8 = min(all.lo, all.hi), high8 = max(all.lo, all.hi);
    const float4 low4 = min(low8.lo, low8.hi), high4 = max(high8.lo, high8.hi);
    const float2 low2 = min(low4.lo, low4.hi), high2 = max(high4.lo, high4.hi);
    return max(high2.x, high2.y) - min(low2.x, low2.y);
}

/* G of a part: the planes blended at the position `u`. */
INLINE void blend_part(const Stack *stack, float u, float t, int left, int top, lanes *red, lanes *green, lanes *blue)
{
    const float s = 0.6f + 0.3f * t, reach = 2.5f * s;
    float sums[3][LANES], weights = 0.0f;
    for (int lane = 0; lane < LANES; lane++)
        sums[0][lane] = sums[1][lane] = sums[2][lane] = 0.0f;
    for (int z = max((int)ceil(u - reach), 0); z <= min((int)(u + reach), stack->planes - 1); z++) {
        const float weight = native_exp((z - u) * (z - u) * (-1.0f / (2.0f * s * s)));
        add_pixels(stack, z, left, top, weight, sums[0], sums[1], sums[2]);
        weights += weight;
    }
    *red = LOAD_LANES(sums[0]) / weights;
    *green = LOAD_LANES(sums[1]) / weights;
    *blue = LOAD_LANES(sums[2]) / weights;
    colours_of(red, green, blue);
}

/* Work-items (1, low height + 2): the pixels between two rows of low cells. The sides of u, nearer and guide must be
 * mirrored. */
__kernel void upsample_depth(__global const float *u, __global const float *nearer, __global const float *guide,
                             __global const Noise *noise, __global const float *evidence, __global const uchar *bytes,
                             __global const ulong2 *table, int4 channels, __global const ushort *codes, int is_linear,
                             __global ushort *depth, int planes, int width, int height, int low_height, int stride)
{
    const Stack stack = {bytes, table, channels, planes, width, height};
    const int low_y = (int)get_global_id(1) - 1;
    const size_t picture = (size_t)low_height * stride;
    Places places;
    find_places(&places);
    size_t rows[4];
    for (int j = 0; j < 4; j++)
        rows[j] = (size_t)reflect(low_y - 1 + j, low_height) * stride + SIDE;

    if (*evidence < LEAST_EVIDENCE) {
        for (int y = max(low_y * SCALE + SCALE / 2, 0); y < min(low_y * SCALE + SCALE * 3 / 2, height); y++)
            for (int x = 0; x < width; x++)
                depth[(size_t)y * width + x] = codes[0];
        return;
    }
    for (int low_x = -1; low_x * SCALE + SCALE / 2 < width; low_x++) {
        float cells[16];
        for (int j = 0; j < 4; j++)
            vstore4(vload4(0, u + rows[j] + low_x - 1), j, cells);
        const int is_edge = spread(cells) >= SAME_DEPTH;
        const float blend_at = 0.25f * (nearer[rows[1] + low_x] + nearer[rows[1] + low_x + 1] +
                                        nearer[rows[2] + low_x] + nearer[rows[2] + low_x + 1]);

        for (int part = 0; part < PARTS; part++) {
            const int left = low_x * SCALE + SCALE / 2 + part % (SCALE / EDGE) * EDGE;
            const int top = low_y * SCALE + SCALE / 2 + part / (SCALE / EDGE) * EDGE;
            const lanes across = places.across[part], down = places.down[part];
            lanes result;
            if (is_edge) {
                lanes red, green, blue, weights = 0.0f;
                blend_part(&stack, blend_at, noise->t, left, top, &red, &green, &blue);
                result = 0.0f;
                UNROLL
                for (int k = 0; k < 16; k++) {
                    __global const float *colour = guide + rows[k / 4] + low_x - 1 + k % 4;
                    const lanes difference = fabs(red - colour[0]) + fabs(green - colour[picture]) +
                                             fabs(blue - colour[2 * picture]);
                    const lanes likeness = max(1.0f - difference * (1.0f / TOLERANCE), 0.0f);
                    const lanes weight = likeness * likeness * places.nearness[part][k] + 1e-5f;
                    weights += weight;
                    result += weight * cells[k];
                }
                result /= weights;
            } else {
                const lanes upper = cells[5] + across * (cells[6] - cells[5]);
                const lanes lower = cells[9] + across * (cells[10] - cells[9]);
                result = upper + down * (lower - upper);
            }
            float positions[LANES];
            STORE_LANES(result, positions);
            write_depth(depth, positions, codes, is_linear, left, top, planes, width, height);
        }
    }
}

/* 255 c at full resolution, bilinear. Work-items (1, height). */
__kernel void upsample_confidence(__global const float *confidence, __global const float *evidence,
                                  __global uchar *upsampled, int width, int low_height, int stride)
{
    const int y = (int)get_global_id(1);
    const float scale = *evidence < LEAST_EVIDENCE ? 0.0f : 255.0f;
    const float fy = (y + 0.5f) / SCALE - 0.5f, low_y = floor(fy);
    __global const float *upper = confidence + (size_t)reflect((int)low_y, low_height) * stride + SIDE;
    __global const float *lower = confidence + (size_t)reflect((int)low_y + 1, low_height) * stride + SIDE;
    for (int x = 0; x < width; x++) {
        const float fx = (x + 0.5f) / SCALE - 0.5f;
        const int low_x = (int)floor(fx);
        const float c = mix(mix(upper[low_x], upper[low_x + 1], fx - low_x),
                            mix(lower[low_x], lower[low_x + 1], fx - low_x), fy - low_y);
        upsampled[(size_t)y * width + x] = convert_uchar_sat_rte(scale * c);
    }
}

/* The depth where c is at least half of its 90th percentile and the pixel did not move, 0 elsewhere. `moved` and
 * `confidence` are of full resolution. Work-items (1, height). */
__kernel void keep_confident(__global const ushort *depth, __global const uchar *confidence,
                             __global const uchar *moved, int use_moved, __global const float *high_confidence,
                             __global ushort *kept, int width)
{
    const size_t row = get_global_id(1) * (size_t)width;
    const float least = 0.5f * 255.0f * *high_confidence;
    for (int x = 0; x < width; x++)
        kept[row + x] = confidence[row + x] < least || (use_moved && moved[row + x]) ? 0 : depth[row + x];
}
