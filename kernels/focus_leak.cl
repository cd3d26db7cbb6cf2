/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Coarse focus without what sharp edges leave in other planes. An edge that is sharp in plane q is a disk of radius
 * r = |q - z| b / (2 SCALE) cells in plane z, and on blank ground its rim is the strongest thing there is. With b the blur
 * step in pixels and M the middle of what cells have,
 *
 *     leak_z(p) = max over q, r >= 1, of 0.9 g r^-.4 max_{|p' - p| <= r + 1} (F_q(p') - M),   F_z <- max(F_z - leak_z, 0)
 *     g = clip(b - 2, 0, 1) (1 - t^2 / 2)
 *
 * What another plane explains is no evidence. Distances are octagonal: steps of a square and of a cross in turn.
 */
#include "low_picture.cl"

/* reached = F - M, leak = 0. medians: of max_z F and of max_z F - min_z F, DN. Work-items (1, low height, planes). */
__kernel void begin_leak(__global const short *focus, __global const float *medians, __global short *reached,
                         __global short *leak, int width, int stride)
{
    const size_t row = (get_global_id(2) * get_global_size(1) + get_global_id(1)) * stride + SIDE;
    const short16 middle = (short16)(short)((medians[0] - 0.5f * medians[1]) * FOCUS_ONE + 0.5f);
    for (int x = 0; x < width; x += 16) {
        SHORTS(reached + row + x) = max(READ_SHORTS(focus + row + x) - middle, (short16)0);
        SHORTS(leak + row + x) = 0;
    }
    mirror_short_ends(reached + row, width);
}

/* The greatest within one cell more. The sides are mirrored, before and after. Work-items (1, low height, planes). */
__kernel void spread_leak(__global const short *reached, __global short *spread, int is_square, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    const size_t plane = get_global_id(2) * (size_t)height * stride + SIDE;
    __global const short *above = reached + plane + (size_t)reflect(y - 1, height) * stride;
    __global const short *here = reached + plane + (size_t)y * stride;
    __global const short *below = reached + plane + (size_t)reflect(y + 1, height) * stride;
    __global short *out = spread + plane + (size_t)y * stride;
    for (int x = 0; x < width; x += 16) {
        short16 highest = max(max(READ_SHORTS(here + x), max(READ_SHORTS(above + x), READ_SHORTS(below + x))),
                              max(READ_SHORTS(here + x - 1), READ_SHORTS(here + x + 1)));
        if (is_square)
            highest = max(highest, max(max(READ_SHORTS(above + x - 1), READ_SHORTS(above + x + 1)),
                                       max(READ_SHORTS(below + x - 1), READ_SHORTS(below + x + 1))));
        SHORTS(out + x) = highest;
    }
    mirror_short_ends(out, width);
}

/* Takes in the planes `distance` away, `share` of whose reached focus is left here. Work-items (1, low height, planes). */
__kernel void gather_leak(__global const short *reached, __global const Noise *noise, __global short *leak, int distance,
                          float share, int width, int stride)
{
    const int z = (int)get_global_id(2), planes = (int)get_global_size(2);
    const size_t plane = get_global_size(1) * stride, row = get_global_id(1) * stride + SIDE;
    const uint part = (uint)(65536.0f * share * (1.0f - 0.5f * noise->t * noise->t));
    for (int x = 0; x < width; x += 16) {
        short16 highest = 0;
        if (z >= distance)
            highest = READ_SHORTS(reached + (z - distance) * plane + row + x);
        if (z + distance < planes)
            highest = max(highest, READ_SHORTS(reached + (z + distance) * plane + row + x));
        const short16 left = as_short16(PART_OF(as_ushort16(highest), part));
        SHORTS(leak + z * plane + row + x) = max(READ_SHORTS(leak + z * plane + row + x), left);
    }
}

/* F less its leak, in place, its sides mirrored. Work-items (1, low height, planes). */
__kernel void take_leak(__global const short *leak, __global short *focus, int width, int stride)
{
    const size_t row = (get_global_id(2) * get_global_size(1) + get_global_id(1)) * stride + SIDE;
    for (int x = 0; x < width; x += 16)
        SHORTS(focus + row + x) = max(READ_SHORTS(focus + row + x) - READ_SHORTS(leak + row + x), (short16)0);
    mirror_short_ends(focus + row, width);
}
