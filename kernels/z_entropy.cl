/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Entropy along z (3) of Oliva-García 2022: H = -sum_b p_b log2 p_b over the histogram of the pixel's luma in the
 * planes, bins of 16 DN (32 DN miss nine in ten of the moving pixels, at 2 bits). Defocus changes a pixel's luma little from plane to plane, a passing object much: where H
 * exceeds the threshold, the pixel moved during the sweep.
 */
#define BIN_SHIFT 4 /* 16 DN */

/* The entropy of 8 bins of a histogram, one byte each. */
inline float entropy_of(ulong bins, int planes)
{
    float entropy = 0.0f;
    for (int shift = 0; shift < 64; shift += 8) {
        const float p = (float)(bins >> shift & 0xff) / planes;
        entropy -= p > 0.0f ? p * log2(p) : 0.0f;
    }
    return entropy;
}

/* moved[height][width]: 255 where H > threshold_bits, else 0. A histogram of 16 bins with at most 64 counts fits the
 * bytes of two ulongs. */
__kernel void z_entropy(__global const uchar *stack, __global const ulong2 *rows, __global uchar *moved, int width,
                        int planes, float threshold_bits)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    ulong dark = 0, bright = 0;
    for (int z = 0; z < planes; z++) {
        const uint bin = (uint)luma_at(stack, rows[z], x, y) >> BIN_SHIFT;
        const ulong one = 1UL << (8 * (bin & 7));
        dark += bin < 8 ? one : 0;
        bright += bin < 8 ? 0 : one;
    }
    const float entropy = entropy_of(dark, planes) + entropy_of(bright, planes);
    moved[(ulong)y * width + x] = entropy > threshold_bits ? 255 : 0;
}
