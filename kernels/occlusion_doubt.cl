/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Doubt of what borders on something farther. What is near covers, out of focus, what lies behind it by half the blur step
 * for each plane between them, so that a foreground grows fat. With b the blur step in pixels, distances in cells:
 *
 *     far(p) = the greatest of u(p') within b / SCALE, and of u(p') - 1.25 (2 SCALE / b) |p' - p| anywhere
 *     d = 1 / (1 + 8 g o max(0, far - u - 0.5)),  g = clip((.5 + t) (b - 2.5 - .5t), 0, 1)
 *     o = clip(1 - (C_f - C_u) / 0.7, 0, 1),  C_f the least C from plane u + 1 to far + 1
 *
 * The confidence c <- d c: where it falls, depth comes from around by colour (depth_fill.cl). What clearly is in no farther
 * plane (o) stays. Distances are octagonal: steps of a square and of a cross in turn. far is in 1/FAR_ONE.
 */
#include "low_picture.cl"

#define FAR_ONE 512 /* 64 planes fit */

/* far of a cell by itself. Its sides are mirrored. Work-items (1, low height). */
__kernel void begin_far(__global const float *u, __global short *far, int width, int stride)
{
    const size_t row = get_global_id(1) * stride + SIDE;
    for (int x = 0; x < width; x += 16)
        SHORTS(far + row + x) = to_wide_shorts(FAR_ONE * READ_WIDE(u + row + x));
    mirror_short_ends(far + row, width);
}

/* One cell farther, `slope` lower. The sides are mirrored, before and after. Work-items (1, low height). */
__kernel void spread_far(__global const short *far, __global short *spread, short slope, int is_square, int width,
                         int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    __global const short *above = far + (size_t)reflect(y - 1, height) * stride + SIDE;
    __global const short *here = far + (size_t)y * stride + SIDE;
    __global const short *below = far + (size_t)reflect(y + 1, height) * stride + SIDE;
    __global short *out = spread + (size_t)y * stride + SIDE;
    for (int x = 0; x < width; x += 16) {
        const short16 own = READ_SHORTS(here + x);
        short16 highest = max(max(READ_SHORTS(above + x), READ_SHORTS(below + x)),
                              max(READ_SHORTS(here + x - 1), READ_SHORTS(here + x + 1)));
        if (is_square)
            highest = max(highest, max(max(READ_SHORTS(above + x - 1), READ_SHORTS(above + x + 1)),
                                       max(READ_SHORTS(below + x - 1), READ_SHORTS(below + x + 1))));
        SHORTS(out + x) = max(own, highest - (short16)slope);
    }
    mirror_short_ends(out, width);
}

/* c <- d c, in place; far is the greater of the two. The sides of c are mirrored. Work-items (1, low height). */
__kernel void doubt_nearer_side(__global const float *u, __global const short *near_by, __global const short *cone,
                                __global const short *cost, __global const Noise *noise, __global float *confidence,
                                float blur_step, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, plane = get_global_size(1) * stride;
    const float share = 8.0f * clamp((0.5f + noise->t) * (blur_step - 2.5f - 0.5f * noise->t), 0.0f, 1.0f);
    for (int x = 0; x < width; x += 16) {
        const float16 position = READ_WIDE(u + row + x);
        const float16 far = convert_float16(max(READ_SHORTS(near_by + row + x), READ_SHORTS(cone + row + x))) * (1.0f / FAR_ONE);
        const float16 beyond = max(far - position - 0.5f, 0.0f);
        if (!any_of(beyond > 0.0f))
            continue;
        const short16 own = convert_short16(rint(position));
        const short16 first = convert_short16(floor(position + 1.0f)) + (short16)1, last = convert_short16(ceil(far + 1.0f)) - (short16)1;
        short16 here = 0, rival = 9 * COST_ONE;
        for (int z = 0; z < planes; z++) {
            const short16 value = READ_SHORTS(cost + z * plane + row + x), index = (short)z;
            here = select(here, value, index == own);
            rival = select(rival, min(rival, value), index >= first & index <= last);
        }
        const float16 open = clamp(1.0f - convert_float16(rival - here) * (1.0f / 0.7f / COST_ONE), 0.0f, 1.0f);
        WIDE(confidence + row + x) = READ_WIDE(confidence + row + x) / (1.0f + share * open * beyond);
    }
    mirror_ends(confidence + row, width);
}
