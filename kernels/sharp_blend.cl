/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * All-in-focus picture that prefers the sharper planes around the depth's plane position u:
 *
 *     w_z = max(1 - |z - u| / REACH, 0) * (F_z / max F)^16,   F_z = box_7x7(G(I_z)) + FLOOR
 *
 * G is the magnitude of the Sobel gradient / 8 of luma. Where the planes lie far apart, interpolation mixes a blurred
 * plane in and a depth that is wrong by a plane shows; the sharpness decides there. Where nothing is sharp all F are
 * alike and the planes are averaged. Without a depth every plane has the first factor 1.
 *
 * Sharpness is ushort[planes][height][width] in 1/256 DN (at most 46163). Samples are SAMPLE, uchar or ushort.
 */
#define REACH 2.0f
#define FLOOR 0.1f /* DN */
#define SHARPNESS_UNIT (1.0f / 256.0f)
#define BOX_RADIUS 3

__kernel void gradient(__global const uchar *stack, __global const ulong2 *rows, __global ushort *sharpness, int width,
                       int height)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= width)
        return;
    const int l = mirror(x - 1, width), r = mirror(x + 1, width);
    const int t = mirror(y - 1, height), b = mirror(y + 1, height);
    const float tl = luma_at(stack, rows[z], l, t), tr = luma_at(stack, rows[z], r, t);
    const float bl = luma_at(stack, rows[z], l, b), br = luma_at(stack, rows[z], r, b);
    const float dx = tr - tl + 2.0f * (luma_at(stack, rows[z], r, y) - luma_at(stack, rows[z], l, y)) + br - bl;
    const float dy = bl - tl + 2.0f * (luma_at(stack, rows[z], x, b) - luma_at(stack, rows[z], x, t)) + br - tr;
    const float magnitude = sqrt(dx * dx + dy * dy) * 0.125f;
    sharpness[((ulong)z * height + y) * width + x] = (ushort)(magnitude / SHARPNESS_UNIT + 0.5f);
}

/* Mean over 7 samples of a row (step_x = 1) or a column (step_y = 1), mirrored at the ends. */
__kernel void box(__global const ushort *source, __global ushort *mean, int width, int height, int step_x, int step_y)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= width)
        return;
    __global const ushort *plane = source + (ulong)z * height * width;
    uint sum = 0;
    for (int i = -BOX_RADIUS; i <= BOX_RADIUS; i++)
        sum += plane[(ulong)mirror(y + i * step_y, height) * width + mirror(x + i * step_x, width)];
    mean[((ulong)z * height + y) * width + x] = (ushort)((sum + BOX_RADIUS) / (2 * BOX_RADIUS + 1));
}

/* Mean plane position of the pixels that a sample stands for, below 0 if none has a depth. */
inline float position_at(__global const ushort *depth, __global const float *positions, int depth_stride, int x, int y,
                         int2 size, int subsampling)
{
    float sum = 0.0f;
    int known = 0;
    for (int j = y * subsampling; j < min((y + 1) * subsampling, size.y); j++)
        for (int i = x * subsampling; i < min((x + 1) * subsampling, size.x); i++) {
            const float u = positions[depth[(ulong)j * depth_stride + i]];
            sum += u >= 0.0f ? u : 0.0f;
            known += u >= 0.0f;
        }
    return known ? sum / known : -1.0f;
}

/* Writes the samples of one component, whose rows the table has from `first_row` on; `channels` interleaved samples
 * share a pixel. */
__kernel void compose_sharp(__global const uchar *stack, __global const ulong2 *table, int first_row,
                            __global const ushort *sharpness, __global const ushort *depth,
                            __global const float *positions, __global uchar *picture, ulong2 picture_rows,
                            int2 component_size, int channels, int subsampling, int2 size, int depth_stride, int planes)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= component_size.x)
        return;
    const float u = position_at(depth, positions, depth_stride, x / channels, y, size, subsampling);
    const int from = u < 0.0f ? 0 : max((int)floor(u - REACH) + 1, 0);
    const int to = u < 0.0f ? planes - 1 : min((int)(u + REACH), planes - 1);
    const ulong area = (ulong)size.x * size.y;
    const ulong pixel = (ulong)(y * subsampling) * size.x + x / channels * subsampling;

    float sharpest = 0.0f;
    for (int z = from; z <= to; z++)
        sharpest = fmax(sharpest, SHARPNESS_UNIT * sharpness[z * area + pixel] + FLOOR);

    float sum = 0.0f, weights = 0.0f;
    for (int z = from; z <= to; z++) {
        const float near = u < 0.0f ? 1.0f : fmax(1.0f - fabs(z - u) / REACH, 0.0f);
        const float share = (SHARPNESS_UNIT * sharpness[z * area + pixel] + FLOOR) / sharpest;
        const float share2 = share * share, share4 = share2 * share2, share8 = share4 * share4;
        const float weight = near * share8 * share8 + 1e-9f; /* never nothing at all */
        const ulong2 rows = table[first_row + z];
        const __global uchar *sample = stack + rows.x + rows.y * (ulong)y + (ulong)x * sizeof(SAMPLE);
        sum += weight * *(const __global SAMPLE *)sample;
        weights += weight;
    }
    __global uchar *sample = picture + picture_rows.x + picture_rows.y * (ulong)y + (ulong)x * sizeof(SAMPLE);
    *(__global SAMPLE *)sample = (SAMPLE)(sum / weights + 0.5f);
}
