/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Stands before every kernel file: how a stack is read.
 *
 * A stack is bytes plus a table of rows: rows[z] = (offset of plane z, stride), both in bytes. Luma and colours are read
 * in DN of 8 bits; with LUMA_BYTES = 2 from little-endian 16-bit samples, whose 65535 is 255 DN.
 */
#ifndef LUMA_BYTES
#define LUMA_BYTES 1
#endif

#define UNKNOWN_PLANE 255

/* Sample i of a row, as it stands there and in DN. */
inline uint sample_of(__global const uchar *row, ulong i)
{
#if LUMA_BYTES == 2
    return row[2 * i] | (uint)row[2 * i + 1] << 8;
#else
    return row[i];
#endif
}

inline float dn_of(__global const uchar *row, ulong i)
{
#if LUMA_BYTES == 2
    return (float)sample_of(row, i) * (255.0f / 65535.0f);
#else
    return (float)row[i];
#endif
}

inline float luma_at(__global const uchar *stack, ulong2 rows, int x, int y)
{
    return dn_of(stack + rows.x + rows.y * (ulong)y, (ulong)x);
}

/* Index i of n samples mirrored at the ends without repeating them: -1 is 1, n is n - 2. Farther than n outside stands
 * the other end. */
inline int mirror(int i, int n)
{
    i = abs(i);
    return i < n ? i : max(2 * n - 2 - i, 0);
}

/* For the kernels in cpu/: 16 lanes that may lie anywhere in memory. */
typedef uchar16 __attribute__((aligned(1))) lanes8;
typedef ushort16 __attribute__((aligned(2))) lanes16;
typedef short16 __attribute__((aligned(2))) slanes16;
typedef int16 __attribute__((aligned(4))) ilanes;
typedef float16 __attribute__((aligned(4))) flanes;
#define LANE ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))

/* Compilers for CPUs need to be told: a call or a short loop left in costs half the speed. */
#ifndef INLINE /* a simulator may know better */
#define INLINE inline __attribute__((always_inline))
#endif

/* Whether a lane is not 0. The built-in any() looks at one after the other on PoCL. */
INLINE int __attribute__((overloadable)) any_of(int8 truth)
{
    const long4 parts = as_long4(truth);
    return (parts.s0 | parts.s1 | parts.s2 | parts.s3) != 0;
}

INLINE int __attribute__((overloadable)) any_of(int16 truth)
{
    return any_of(truth.lo | truth.hi);
}

/* Runs over a row of 16 pixels or more; the last lanes overlap the ones before, so that nothing outside is touched. */
#define FOR_EACH_16(x, width) for (int x = 0; x < (width); x = x + 16 < (width) ? min(x + 16, (width) - 16) : (width))
