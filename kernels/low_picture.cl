/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Included by the kernels of method=volume: pictures at 1/SCALE of the stack's resolution.
 *
 * A low picture is float[height][stride] or short[height][stride]; cell (x, y) lies at y * stride + SIDE + x, so that
 * every row has at least SIDE cells of room at both ends, the 8 nearest of which a stage mirrors where the next one looks
 * beside a cell. Rows are worked on in vectors of 8 or 16 from x = 0, which may write up to SIDE cells beyond the width. A
 * volume is `planes` such pictures one after the other. One work-item takes a row or a strip of rows: this is what
 * vectorises on a CPU.
 *
 * Shorts are in fixed point: colours in 1/COLOUR_ONE DN, focus in 1/FOCUS_ONE DN, costs in 1/COST_ONE.
 */
#include "noise_type.cl"

#define SIDE 16

#define UNROLL _Pragma("unroll")

#define COLOUR_ONE 16
#define FOCUS_ONE 32
#define COST_ONE 1024

typedef float8 float8_anywhere __attribute__((aligned(4)));
#define CELLS(pointer) (*(__global float8_anywhere *)(pointer))
#define READ_CELLS(pointer) (*(__global const float8_anywhere *)(pointer))

typedef float16 float16_anywhere __attribute__((aligned(4)));
#define WIDE(pointer) (*(__global float16_anywhere *)(pointer))
#define READ_WIDE(pointer) (*(__global const float16_anywhere *)(pointer))

typedef short8 short8_anywhere __attribute__((aligned(2)));
typedef short16 short16_anywhere __attribute__((aligned(2)));
typedef ushort16 ushort16_anywhere __attribute__((aligned(2)));
#define SHORTS(pointer) (*(__global short16_anywhere *)(pointer))
#define READ_SHORTS(pointer) (*(__global const short16_anywhere *)(pointer))
#define USHORTS(pointer) (*(__global ushort16_anywhere *)(pointer))
#define READ_USHORTS(pointer) (*(__global const ushort16_anywhere *)(pointer))
#define HALF_SHORTS(pointer) (*(__global short8_anywhere *)(pointer))
#define READ_HALF_SHORTS(pointer) (*(__global const short8_anywhere *)(pointer))
#define READ_SHORT_CELLS(pointer) convert_float8(READ_HALF_SHORTS(pointer))
#define READ_WIDE_SHORTS(pointer) convert_float16(READ_SHORTS(pointer))

/* (a + b) / 2, halves rounded up; |a - b|; a part / 65536, rounded down: one or two instructions on CPUs. */
INLINE ushort16 mean_of(ushort16 a, ushort16 b)
{
    return convert_ushort16((convert_uint16(a) + convert_uint16(b) + 1u) >> 1u);
}

INLINE ushort16 difference(ushort16 a, ushort16 b)
{
    return max(a, b) - min(a, b);
}

#define PART_OF(a, part) convert_ushort16((convert_uint16(a) * (uint)(part)) >> 16u)

/* Rounds v >= -32768. */
INLINE short8 to_shorts(float8 v)
{
    return convert_short8(convert_int8(v + 32768.5f) - 32768);
}

INLINE short16 to_wide_shorts(float16 v)
{
    return convert_short16(convert_int16(v + 32768.5f) - 32768);
}

/* Mirrors the 8 cells at both ends of a row into its sides; `row` points at cell 0. */
INLINE void mirror_ends(__global float *row, int width)
{
    CELLS(row - 8) = READ_CELLS(row).s76543210;
    CELLS(row + width) = READ_CELLS(row + width - 8).s76543210;
}

INLINE void mirror_short_ends(__global short *row, int width)
{
    HALF_SHORTS(row - 8) = READ_HALF_SHORTS(row).s76543210;
    HALF_SHORTS(row + width) = READ_HALF_SHORTS(row + width - 8).s76543210;
}

/* exp(x), x <= 0, to 0.2 %: 2^f as a parabola on the fraction f of x log2 e; the library's is slower. 0 below -80. */
#define QUICK_EXP(floats, ints, convert_ints)                                                                          \
    INLINE floats __attribute__((overloadable)) quick_exp(floats x)                                                    \
    {                                                                                                                  \
        const floats power = max(x, -80.0f) * 1.44269504f;                                                             \
        const floats whole = floor(power), fraction = power - whole;                                                   \
        const floats mantissa = 1.00172476f + fraction * (0.65763628f + fraction * 0.33718944f);                       \
        return as_##floats(as_##ints(mantissa) + (convert_ints(whole) << 23));                                         \
    }
QUICK_EXP(float8, int8, convert_int8)
QUICK_EXP(float16, int16, convert_int16)

/* Index i of n cells mirrored at the ends, the end cells repeated: -1 is 0, n is n - 1. */
INLINE int reflect(int i, int n)
{
    i = i < 0 ? -1 - i : i;
    i = i < n ? i : 2 * n - 1 - i;
    return clamp(i, 0, n - 1);
}

/* A stack whose focus measure differs less than this over the planes, in DN, at every cell tells no depth. */
#define LEAST_EVIDENCE 0.01f
