/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Noise of a stack (Immerkaer 1996): sigma_z = 1.4826 median |K * luma_z| / 6, K = [1 -2 1] x [1 -2 1]; the least over
 * the planes, because a blurred plane shows noise alone. Luma is BT.601 in DN, a subsample of the pixels is looked at.
 */
#include "low_picture.cl"

#define BINS 1024
#define BINS_A_DN 8

inline float noise_luma_at(__global const uchar *stack, ulong2 rows, int4 channels, int x, int y)
{
#ifdef INTERLEAVED
    __global const uchar *row = stack + rows.x + rows.y * (ulong)y;
    const ulong pixel = (ulong)x * channels.s0;
    return 0.299f * dn_of(row, pixel + channels.s1) + 0.587f * dn_of(row, pixel + channels.s2) +
           0.114f * dn_of(row, pixel + channels.s3);
#else
    return luma_at(stack, rows, x, y);
#endif
}

/* Median of a histogram of `count` values, in bins. */
inline float median_bin(__global const uint *histogram, uint count)
{
    uint below = 0;
    int bin = 0;
    while (bin < BINS - 1 && 2 * (below + histogram[bin]) < count)
        below += histogram[bin++];
    return bin + (0.5f * count - below) / max(histogram[bin], 1u);
}

/* Planes whose bit of `wanted` is not set keep their sigma. Work-items (1, planes); every step-th pixel in both directions. histograms[planes][BINS]. */
__kernel void plane_noise(__global const uchar *stack, __global const ulong2 *rows, int4 channels, ulong wanted,
                          __global uint *histograms, __global float *sigmas, int width, int height, int step)
{
    const int z = (int)get_global_id(1);
    if (!(wanted >> z & 1))
        return;
    __global uint *histogram = histograms + z * BINS;
    for (int bin = 0; bin < BINS; bin++)
        histogram[bin] = 0;

    uint count = 0;
    for (int y = 1; y < height - 1; y += step)
        for (int x = 1; x < width - 1; x += step) {
            float column[3];
            for (int i = -1; i <= 1; i++)
                column[i + 1] = noise_luma_at(stack, rows[z], channels, x + i, y - 1) -
                                2.0f * noise_luma_at(stack, rows[z], channels, x + i, y) +
                                noise_luma_at(stack, rows[z], channels, x + i, y + 1);
            const float response = fabs(column[0] - 2.0f * column[1] + column[2]);
            histogram[min((int)(response * BINS_A_DN), BINS - 1)]++;
            count++;
        }
    sigmas[z] = 1.4826f / 6.0f / BINS_A_DN * median_bin(histogram, count);
}

/* The pre-blur's sigma in pixels over t (scale + 2): where all planes are equally noisy, and where one is by 30 % more so
 * than another. Alignment smooths all planes but the middle one, whose noise then passes for focus. */
#define EVEN_BLUR 0.2f
#define UNEVEN_BLUR 0.28f

/* One work-item. The pre-blur is a Gaussian, none below a quarter of a pixel. With `is_rolling` the one
 * before is kept where no tap differs by more than 1, since the planes that have not changed were blurred by it. */
__kernel void judge_noise(__global const float *sigmas, __global Noise *noise, int planes, int scale, int is_rolling,
                          float told)
{
    float sigma = sigmas[0], highest = sigmas[0];
    for (int z = 1; z < planes; z++) {
        sigma = min(sigma, sigmas[z]);
        highest = max(highest, sigmas[z]);
    }
    if (told >= 0.0f)
        sigma = highest = told;
    const float t = sigma * sigma / (sigma * sigma + 1.0f);
    noise->sigma = sigma;
    noise->t = t;

    const float unevenness = clamp((highest / max(sigma, 1e-3f) - 1.1f) / 0.2f, 0.0f, 1.0f);
    const float blur = t * (scale + 2) * mix(EVEN_BLUR, UNEVEN_BLUR, unevenness);
    float weights[4], sum = -1.0f;
    for (int i = 0; i < 4; i++) {
        weights[i] = blur > 0.25f ? exp(-i * i / (2.0f * blur * blur)) : i == 0;
        sum += 2.0f * weights[i];
    }
    int taps[4], is_near = is_rolling;
    taps[0] = 64;
    for (int i = 3; i > 0; i--) {
        taps[i] = convert_int_rte(64.0f * weights[i] / sum);
        taps[0] -= 2 * taps[i];
    }
    for (int i = 0; i < 4; i++)
        is_near = is_near && abs(taps[i] - noise->taps[i]) <= (i == 0 ? 2 : 1);
    noise->is_new = !is_near;
    for (int i = 0; i < 4; i++)
        noise->taps[i] = is_near ? noise->taps[i] : taps[i];
}
