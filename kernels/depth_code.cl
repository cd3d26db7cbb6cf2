/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Plane positions u in [0, planes - 1] to the pixels of a depth map. `codes` holds the pixel value for each of the
 * 65535 positions u = (planes - 1) (i - 1) / 65534, i = 1..65535, and 0 ("no value") for i = 0.
 */

__kernel void code_positions(__global const float *u, __global const ushort *codes, __global ushort *depth, int width,
                             int planes)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    const ulong pixel = (ulong)y * width + x;
    const float position = u[pixel];
    const float share = clamp(position / (planes - 1), 0.0f, 1.0f);
    depth[pixel] = isnan(position) ? codes[0] : codes[1 + convert_int_rte(65534.0f * share)];
}

/* The same of places in half planes. */
__kernel void code_places(__global const uchar *sparse, __global const ushort *codes, __global ushort *depth, int width,
                          int planes)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
    const ulong pixel = (ulong)y * width + x;
    const int place = sparse[pixel];
    depth[pixel] = place == UNKNOWN_PLANE ? codes[0] : codes[1 + (32767 * place + (planes - 1) / 2) / (planes - 1)];
}
