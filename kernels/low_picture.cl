/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Included by the kernels of method=volume: pictures at 1/SCALE of the stack's resolution.
 *
 * A low picture is float[height][stride]; cell (x, y) lies at y * stride + SIDE + x, so that every row has at least
 * SIDE cells of room at both ends; mirror_sides fills the 8 nearest. Rows are worked on in vectors of 8 from x = 0; what the last vector writes beyond
 * the width, mirror_sides replaces. A volume is `planes` such pictures one after the other. One work-item takes a row
 * or a strip of rows: this is what vectorises on a CPU.
 */
#include "noise_type.cl"

#define SIDE 16

typedef float8 float8_anywhere __attribute__((aligned(4)));
#define CELLS(pointer) (*(__global float8_anywhere *)(pointer))
#define READ_CELLS(pointer) (*(__global const float8_anywhere *)(pointer))

/* exp(x), x <= 0, to 0.2 %: 2^f as a parabola on the fraction f of x log2 e; the library's is slower. 0 below -80. */
inline float8 quick_exp(float8 x)
{
    const float8 power = max(x, -80.0f) * 1.44269504f;
    const float8 whole = floor(power), fraction = power - whole;
    const float8 mantissa = 1.00172476f + fraction * (0.65763628f + fraction * 0.33718944f);
    return as_float8(as_int8(mantissa) + (convert_int8(whole) << 23));
}

/* Index i of n cells mirrored at the ends, the end cells repeated: -1 is 0, n is n - 1. */
inline int reflect(int i, int n)
{
    i = i < 0 ? -1 - i : i;
    i = i < n ? i : 2 * n - 1 - i;
    return clamp(i, 0, n - 1);
}


/* A stack whose focus measure differs less than this over the planes, in DN, at every cell tells no depth. */
#define LEAST_EVIDENCE 0.01f
