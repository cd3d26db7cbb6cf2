/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Entropy along z (3) of Oliva-García 2022: H = -sum_b p_b log2 p_b over the histogram of the pixel's luma in the
 * planes, bins of 32 DN. Defocus changes a pixel's luma little from plane to plane, a passing object much: where H
 * exceeds the threshold, the pixel moved during the sweep.
 */
#define BIN_SHIFT 5 /* 32 DN */

/* moved[height][width]: 255 where H > threshold_bits, else 0. A histogram of 8 bins with at most 64 counts fits the
 * bytes of a ulong. */
__kernel void z_entropy(__global const uchar *stack, __global const ulong2 *rows, __global uchar *moved, int width,
                        int planes, float threshold_bits)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    ulong histogram = 0;
    for (int z = 0; z < planes; z++) {
        const uint bin = (uint)luma_at(stack, rows[z], x, y) >> BIN_SHIFT;
        histogram += 1UL << (8 * bin);
    }
    float entropy = 0.0f;
    for (int bin = 0; bin < 8; bin++) {
        const float p = (float)(histogram >> (8 * bin) & 0xff) / planes;
        entropy -= p > 0.0f ? p * log2(p) : 0.0f;
    }
    moved[(ulong)y * width + x] = entropy > threshold_bits ? 255 : 0;
}
