/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The focus measure of (2) of Oliva-García 2022, before its maximum over z:
 *
 *     P_z = G(I_z) * prod_{i=2..LEVELS} U_i(G(R_{1/i}(I_z)))
 *
 * G: magnitude of the Sobel 3x3 gradient / 8; R_{1/i}: mean over i x i pixels; U_i: bilinear. Beyond the border stands
 * the picture, mirrored, at every level.
 * A level's coarse pictures are float[planes][rows + 4][columns + 4], two samples beyond every border, with rows and
 * columns of i pixels, the last one begun; gradients float[planes][rows + 2][columns + 2], all levels one after the
 * other from i = 2.
 */

inline float magnitude(float dx, float dy)
{
    return sqrt(dx * dx + dy * dy) * 0.125f;
}

/* R_{1/level}. */
__kernel void downsample(__global const uchar *stack, __global const ulong2 *rows, __global float *coarse, int width,
                         int height, int coarse_width, int coarse_height, int level)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= coarse_width)
        return;
    const int left = (x - 2) * level, top = (y - 2) * level;
    float sum = 0.0f;
    for (int j = top; j < top + level; j++)
        for (int i = left; i < left + level; i++)
            sum += luma_at(stack, rows[z], mirror(i, width), mirror(j, height));
    coarse[((ulong)z * coarse_height + y) * coarse_width + x] = sum / (level * level);
}

/* G of a coarse picture two samples wider and higher, written at gradient[first...]. */
__kernel void coarse_gradient(__global const float *coarse, __global float *gradient, ulong first, int width, int height)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= width)
        return;
    const int stride = width + 2;
    __global const float *above = coarse + ((ulong)z * (height + 2) + y) * stride + x;
    __global const float *here = above + stride, *below = here + stride;
    const float dx = above[2] - above[0] + 2.0f * (here[2] - here[0]) + below[2] - below[0];
    const float dy = below[0] - above[0] + 2.0f * (below[1] - above[1]) + below[2] - above[2];
    gradient[first + ((ulong)z * height + y) * width + x] = magnitude(dx, dy);
}

/* G of a full-resolution plane at (x, y). */
inline float fine_gradient(__global const uchar *stack, ulong2 rows, int x, int y, int width, int height)
{
    const int l = mirror(x - 1, width), r = mirror(x + 1, width);
    const int t = mirror(y - 1, height), b = mirror(y + 1, height);
    const float tl = luma_at(stack, rows, l, t), tr = luma_at(stack, rows, r, t);
    const float bl = luma_at(stack, rows, l, b), br = luma_at(stack, rows, r, b);
    const float dx = tr - tl + 2.0f * (luma_at(stack, rows, r, y) - luma_at(stack, rows, l, y)) + br - bl;
    const float dy = bl - tl + 2.0f * (luma_at(stack, rows, x, b) - luma_at(stack, rows, x, t)) + br - tr;
    return magnitude(dx, dy);
}

/* The four gradients of a level around a fine pixel, and how far between them it lies. */
typedef struct {
    ulong first;  /* of the level's plane 0 */
    ulong area;   /* samples a plane */
    ulong top, bottom;
    int left, right;
    float fx, fy;
} Footprint;

inline Footprint footprint(ulong first, int x, int y, int width, int height, int level)
{
    const int w = (width + level - 1) / level + 2, h = (height + level - 1) / level + 2;
    const float px = (x + 0.5f) / level + 0.5f, py = (y + 0.5f) / level + 0.5f;
    Footprint f;
    f.first = first;
    f.area = (ulong)w * h;
    f.left = (int)px;
    f.right = f.left + 1;
    f.top = (ulong)w * (int)py;
    f.bottom = f.top + w;
    f.fx = px - f.left;
    f.fy = py - (int)py;
    return f;
}

inline float upsample(__global const float *gradient, const Footprint *f, int z)
{
    __global const float *plane = gradient + f->first + f->area * z;
    const float upper = mix(plane[f->top + f->left], plane[f->top + f->right], f->fx);
    const float lower = mix(plane[f->bottom + f->left], plane[f->bottom + f->right], f->fx);
    return mix(upper, lower, f->fy);
}

/* Per pixel: max over z of P, where it is, and the mean over z. Places are half planes, so that where two planes next to
 * each other are equally sharp their middle can be said. */
__kernel void focus_product(__global const uchar *stack, __global const ulong2 *rows, __global const float *gradient,
                            __global float *peak, __global uchar *place, __global float *mean, int width,
                            int height, int planes)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width)
        return;
#if LEVELS > 1
    Footprint coarse[LEVELS - 1];
    ulong first = 0;
    for (int i = 2; i <= LEVELS; i++) {
        coarse[i - 2] = footprint(first, x, y, width, height, i);
        first += coarse[i - 2].area * planes;
    }
#endif
    float best = -1.0f, sum = 0.0f;
    int best_place = 0;
    for (int z = 0; z < planes; z++) {
        float product = fine_gradient(stack, rows[z], x, y, width, height);
#if LEVELS > 1
        for (int i = 0; i < LEVELS - 1; i++)
            product *= upsample(gradient, &coarse[i], z);
#endif
        sum += product;
        if (product > best) {
            best = product;
            best_place = 2 * z;
        } else if (product == best)
            best_place++;
    }
    const ulong pixel = (ulong)y * width + x;
    peak[pixel] = best;
    place[pixel] = (uchar)best_place;
    mean[pixel] = sum / planes;
}
