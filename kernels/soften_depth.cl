/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The depth that an all-in-focus picture is taken at: mean_3x3(min_3x3(depth)) of the pixels of a depth map. Over an
 * edge, a foreground a little too fat hides the halo around it, and steps in depth do not become steps in the picture.
 *
 * Pixels without a depth (0) keep none and count for no other. The outermost rows repeat; the outermost columns stay as
 * they are. Work-items (1, height), rows of 18 pixels or more.
 */
typedef ushort16 ushort16_anywhere __attribute__((aligned(2)));
#define READ(pointer) (*(__global const ushort16_anywhere *)(pointer))

#define NONE 65535

/* From depth + stride * y to packed rows: the least pixel around - 1, NONE where there is none. */
__kernel void nearest_pixel(__global const ushort *depth, __global ushort *nearest, int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    __global const ushort *rows[3] = {depth + (size_t)max(y - 1, 0) * stride, depth + (size_t)y * stride,
                                      depth + (size_t)min(y + 1, height - 1) * stride};
    __global ushort *out = nearest + (size_t)y * width;
    out[0] = rows[1][0] - 1;
    out[width - 1] = rows[1][width - 1] - 1;
    for (int block = 1; block < width - 1; block += 16) {
        const int x = min(block, width - 17);
        ushort16 least = NONE;
        for (int j = 0; j < 3; j++)
            for (int i = -1; i <= 1; i++)
                least = min(least, READ(rows[j] + x + i) - (ushort)1);
        *(__global ushort16_anywhere *)(out + x) = least;
    }
}

inline uint16 or_own(ushort16 other, ushort16 own)
{
    return convert_uint16(select(other, own, other == (ushort16)NONE));
}

/* softened: packed rows. */
__kernel void mean_pixel(__global const ushort *depth, __global const ushort *nearest, __global ushort *softened,
                         int width, int stride)
{
    const int y = (int)get_global_id(1), height = (int)get_global_size(1);
    __global const ushort *rows[3] = {nearest + (size_t)max(y - 1, 0) * width, nearest + (size_t)y * width,
                                      nearest + (size_t)min(y + 1, height - 1) * width};
    __global ushort *out = softened + (size_t)y * width;
    depth += (size_t)y * stride;
    out[0] = depth[0];
    out[width - 1] = depth[width - 1];
    for (int block = 1; block < width - 1; block += 16) {
        const int x = min(block, width - 17);
        const ushort16 own = READ(rows[1] + x);
        uint16 sum = 4;
        for (int j = 0; j < 3; j++)
            for (int i = -1; i <= 1; i++)
                sum += or_own(READ(rows[j] + x + i), own);
        const ushort16 mean = convert_ushort16(convert_float16(sum) * (1.0f / 9.0f)) + (ushort)1;
        *(__global ushort16_anywhere *)(out + x) = select(mean, (ushort16)0, READ(depth + x) == (ushort16)0);
    }
}
