/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The focus measure of (2) of Oliva-García 2022, before its maximum over z:
 *
 *     P_z = G(I_z) * prod_{i=2..LEVELS} U_i(G(R_{1/i}(I_z)))
 *
 * G: magnitude of the Sobel 3x3 gradient / 8; R_{1/i}: area downsample to width / i x height / i; U_i: bilinear.
 * Coarse pictures are float[planes][height / i][width / i], all levels one after the other from i = 2.
 */

inline float magnitude(float dx, float dy)
{
    return sqrt(dx * dx + dy * dy) * 0.125f;
}

/* Share of source sample i that the span [from, to) covers. */
inline float overlap(int i, float from, float to)
{
    return fmax(fmin(to, i + 1.0f) - fmax(from, (float)i), 0.0f);
}

/* R_{1/i}: mean over the source area of each coarse sample; the area's edges may cut samples. */
__kernel void downsample(__global const uchar *stack, __global const ulong2 *rows, __global float *coarse, int width,
                         int height, int coarse_width, int coarse_height)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= coarse_width)
        return;
    const float step_x = (float)width / coarse_width, step_y = (float)height / coarse_height;
    const float left = x * step_x, right = fmin(left + step_x, (float)width);
    const float top = y * step_y, bottom = fmin(top + step_y, (float)height);
    const int end_x = min((int)ceil(right), width), end_y = min((int)ceil(bottom), height);

    float sum = 0.0f;
    for (int j = (int)top; j < end_y; j++) {
        float row = 0.0f;
        for (int i = (int)left; i < end_x; i++)
            row += overlap(i, left, right) * luma_at(stack, rows[z], i, j);
        sum += overlap(j, top, bottom) * row;
    }
    coarse[((ulong)z * coarse_height + y) * coarse_width + x] = sum / ((right - left) * (bottom - top));
}

/* G of a coarse picture, written at gradient[first...]. */
__kernel void coarse_gradient(__global const float *coarse, __global float *gradient, ulong first, int width, int height)
{
    const int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= width)
        return;
    __global const float *plane = coarse + (ulong)z * width * height;
    __global const float *above = plane + (ulong)mirror(y - 1, height) * width;
    __global const float *here = plane + (ulong)y * width;
    __global const float *below = plane + (ulong)mirror(y + 1, height) * width;
    const int l = mirror(x - 1, width), r = mirror(x + 1, width);
    const float dx = above[r] - above[l] + 2.0f * (here[r] - here[l]) + below[r] - below[l];
    const float dy = below[l] - above[l] + 2.0f * (below[x] - above[x]) + below[r] - above[r];
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

/* The four samples of a coarse picture around a fine pixel, and how far between them it lies. */
typedef struct {
    ulong first;  /* of the level's plane 0 */
    ulong area;   /* samples a plane */
    ulong top, bottom;
    int left, right;
    float fx, fy;
} Footprint;

inline float position(int fine, int fine_size, int coarse_size)
{
    const float p = (fine + 0.5f) * coarse_size / fine_size - 0.5f;
    return clamp(p, 0.0f, coarse_size - 1.0f);
}

inline Footprint footprint(ulong first, int x, int y, int width, int height, int level)
{
    const int w = max(width / level, 1), h = max(height / level, 1);
    const float px = position(x, width, w), py = position(y, height, h);
    Footprint f;
    f.first = first;
    f.area = (ulong)w * h;
    f.left = (int)px;
    f.right = min(f.left + 1, w - 1);
    f.top = (ulong)w * (int)py;
    f.bottom = (ulong)w * min((int)py + 1, h - 1);
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

/* Per pixel: max over z of P, the plane where it is, and the mean over z. */
__kernel void focus_product(__global const uchar *stack, __global const ulong2 *rows, __global const float *gradient,
                            __global float *peak, __global uchar *peak_plane, __global float *mean, int width,
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
    int best_plane = 0;
    for (int z = 0; z < planes; z++) {
        float product = fine_gradient(stack, rows[z], x, y, width, height);
#if LEVELS > 1
        for (int i = 0; i < LEVELS - 1; i++)
            product *= upsample(gradient, &coarse[i], z);
#endif
        sum += product;
        if (product > best) {
            best = product;
            best_plane = z;
        }
    }
    const ulong pixel = (ulong)y * width + x;
    peak[pixel] = best;
    peak_plane[pixel] = (uchar)best_plane;
    mean[pixel] = sum / planes;
}
