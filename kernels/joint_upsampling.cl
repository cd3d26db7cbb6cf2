/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * u at full resolution from the low u (Kopf et al. 2007): the mean of the 4x4 low cells around a pixel, weighted by
 *
 *     max(0, 1 - |G(p) - A(q)|_1 / 60)^2 exp(-d^2 / (2 1.5^2)) (1 + 4 u(q) / (N - 1)) + 1e-5,  d in low cells,
 *
 * where these cells differ by half a plane or more, bilinear elsewhere. A is the guide at the final u, and G its like at
 * full resolution: the planes blended at the nearer u around the pixel. Only pixels near depth edges need G. What is
 * farther counts more, since blur makes what is near grow over its edges.
 *
 * All pixels between four low cells have the same 4x4 cells: such a square of SCALE x SCALE pixels is worked on at
 * once, in the parts of plane_blend.cl.
 */
#include "plane_blend.cl"

#define SAME_DEPTH 0.5f /* planes */
#define TOLERANCE 60.0f /* DN, the three colours together */

typedef uint __attribute__((aligned(2))) uint_anywhere;
typedef int16 __attribute__((aligned(2))) ints_anywhere;

/* The pixels of a part in the order of lanes, how near they are to each of the 4x4 cells. */
typedef struct {
    lanes nearness[PARTS][16];
} Places;

INLINE void find_places(Places *places)
{
    float nearness[SCALE][4];
    for (int i = 0; i < SCALE; i++)
        for (int k = 0; k < 4; k++) {
            const float distance = (i + 0.5f) / SCALE - (k - 1.0f);
            nearness[i][k] = native_exp(distance * distance * (-1.0f / 4.5f));
        }
    for (int part = 0; part < PARTS; part++)
        for (int k = 0; k < 16; k++) {
            const int right = part % (SCALE / EDGE) * EDGE, down = part / (SCALE / EDGE) * EDGE;
            pixels rows[EDGE];
            for (int j = 0; j < EDGE; j++) {
                float row[EDGE];
                for (int i = 0; i < EDGE; i++)
                    row[i] = nearness[right + i][k % 4] * nearness[down + j][k / 4];
                rows[j] = LOAD_PIXELS(row);
            }
            places->nearness[part][k] = JOIN(rows);
        }
}

/* The numbers of depth_code.cl of positions u. */
#define NUMBER(u, planes) (clamp((u) * (1.0f / ((planes) - 1)), 0.0f, 1.0f) * 65534.0f + 1.5f)

/* Numbers of the pixels between two rows of cells, bilinear: 8 squares at a time, from the one whose upper left cell is
 * low_x. Pixels outside are left out. */
INLINE void write_bilinear(__global const float *upper, __global const float *lower, __global ushort *depth, int low_x,
                           int top, int planes, int width, int height)
{
    const float8 upper_left = READ_CELLS(upper + low_x), upper_right = READ_CELLS(upper + low_x + 1);
    const float8 lower_left = READ_CELLS(lower + low_x), lower_right = READ_CELLS(lower + low_x + 1);
    const int left = low_x * SCALE + SCALE / 2, is_inside = left >= 0 && left + 8 * SCALE <= width;
    for (int j = max(-top, 0); j < min(SCALE, height - top); j++) {
        const float down = (j + 0.5f) / SCALE;
        const float8 start = upper_left + down * (lower_left - upper_left);
        const float8 end = upper_right + down * (lower_right - upper_right);
        __global ushort *row = depth + (size_t)(top + j) * width;
        int8 numbers[SCALE];
        UNROLL
        for (int i = 0; i < SCALE; i++)
            numbers[i] = convert_int8(NUMBER(start + (i + 0.5f) / SCALE * (end - start), planes));
        if (is_inside) {
            /* Two pixels a 32-bit lane, then pairs side by side. */
#if SCALE == 2
            *(__global lanes16 *)(row + left) = as_ushort16(numbers[0] | numbers[1] << 16);
#else
            UNROLL
            for (int i = 0; i < SCALE; i += 4) {
                const int8 first = numbers[i] | numbers[i + 1] << 16, second = numbers[i + 2] | numbers[i + 3] << 16;
#if SCALE == 4
                *(__global ints_anywhere *)(row + left) =
                    (int16)(first.s0, second.s0, first.s1, second.s1, first.s2, second.s2, first.s3, second.s3, first.s4,
                            second.s4, first.s5, second.s5, first.s6, second.s6, first.s7, second.s7);
#else
                const int *lower_pairs = (const int *)&first, *higher_pairs = (const int *)&second;
                for (int k = 0; k < 8; k++) {
                    *(__global uint_anywhere *)(row + left + 8 * k + i) = (uint)lower_pairs[k];
                    *(__global uint_anywhere *)(row + left + 8 * k + i + 2) = (uint)higher_pairs[k];
                }
#endif
            }
#endif
            continue;
        }
        for (int k = 0; k < 8; k++)
            for (int i = 0; i < SCALE; i++) {
                const int x = left + k * SCALE + i;
                if (x >= 0 && x < width)
                    row[x] = (ushort)((const int *)&numbers[i])[k];
            }
    }
}

/* Which of 8 squares have cells around them that differ in depth. rows: of the 4 rows of cells. */
INLINE int8 are_edges(__global const float *u, const size_t *rows, int low_x)
{
    float8 least = INFINITY, most = -INFINITY;
    UNROLL
    for (int k = 0; k < 16; k++) {
        const float8 cells = READ_CELLS(u + rows[k / 4] + low_x - 1 + k % 4);
        least = min(least, cells);
        most = max(most, cells);
    }
    return most - least >= SAME_DEPTH;
}

/* Work-items (1, low height + 2): the pixels between two rows of low cells. The sides of u, nearer and guide must be
 * mirrored. */
__kernel void upsample_depth(__global const float *u, __global const float *nearer, __global const float *guide,
                             __global const Noise *noise, __global const float *evidence, __global const uchar *bytes,
                             __global const ulong2 *table, int4 channels, __global const ushort *codes, int is_linear,
                             __global ushort *depth, int planes, int width, int height, int low_height, int stride)
{
    const Stack stack = {bytes, table, channels, planes, width, height};
    const int low_y = (int)get_global_id(1) - 1, upper_pixel = low_y * SCALE + SCALE / 2;
    const int first_row = max(upper_pixel, 0), end_row = min(upper_pixel + SCALE, height);
    const size_t picture = (size_t)low_height * stride;

    if (*evidence < LEAST_EVIDENCE) {
        for (int y = first_row; y < end_row; y++)
            for (int x = 0; x < width; x++)
                depth[(size_t)y * width + x] = codes[0];
        return;
    }
    const float farness = 4.0f / (planes - 1);
    Places places;
    find_places(&places);
    size_t rows[4];
    for (int j = 0; j < 4; j++)
        rows[j] = (size_t)reflect(low_y - 1 + j, low_height) * stride + SIDE;

    for (int low_x = -1; low_x * SCALE + SCALE / 2 < width; low_x += 8) {
        write_bilinear(u + rows[1], u + rows[2], depth, low_x, upper_pixel, planes, width, height);
        const int8 edges = are_edges(u, rows, low_x);
        if (!any_of(edges))
            continue;
        int is_edge[8];
        vstore8(edges, 0, is_edge);
        for (int square = 0; square < 8; square++) {
            const int x = low_x + square;
            if (!is_edge[square] || x * SCALE + SCALE / 2 >= width)
                continue;
            const float position = 0.25f * (nearer[rows[1] + x] + nearer[rows[1] + x + 1] + nearer[rows[2] + x] +
                                            nearer[rows[2] + x + 1]);
            const Blend blend = blend_at(position, noise->t, planes);
            for (int part = 0; part < PARTS; part++) {
                const int left = x * SCALE + SCALE / 2 + part % (SCALE / EDGE) * EDGE;
                const int top = upper_pixel + part / (SCALE / EDGE) * EDGE;
                const int is_inside = left >= 0 && top >= 0 && left + EDGE <= width && top + EDGE <= height;
                const Colours own = is_inside ? blend_part(&stack, &blend, left, top)
                                              : blend_any_part(&stack, &blend, left, top);
                lanes weights = 0.0f, sum = 0.0f;
                UNROLL
                for (int k = 0; k < 16; k++) {
                    const size_t cell = rows[k / 4] + x - 1 + k % 4;
                    const lanes difference = fabs(own.red - guide[cell]) + fabs(own.green - guide[picture + cell]) +
                                             fabs(own.blue - guide[2 * picture + cell]);
                    const lanes likeness = max(1.0f - difference * (1.0f / TOLERANCE), 0.0f);
                    const lanes weight = likeness * likeness * places.nearness[part][k] * (1.0f + farness * u[cell]) + 1e-5f;
                    weights += weight;
                    sum += weight * u[cell];
                }
                float numbers[LANES];
                STORE_LANES(NUMBER(sum / weights, planes), numbers);
                if (is_inside) {
                    for (int j = 0; j < EDGE; j++)
                        *(__global codes_anywhere *)(depth + (size_t)(top + j) * width + left) =
                            CONVERT_CODES(LOAD_PIXELS(numbers + j * EDGE));
                    continue;
                }
                for (int j = max(-top, 0); j < min(EDGE, height - top); j++)
                    for (int i = max(-left, 0); i < min(EDGE, width - left); i++)
                        depth[(size_t)(top + j) * width + left + i] = (ushort)(int)numbers[j * EDGE + i];
            }
        }
    }
    for (int y = first_row; y < end_row && !is_linear; y++)
        for (int x = 0; x < width; x++)
            depth[(size_t)y * width + x] = codes[depth[(size_t)y * width + x]];
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
