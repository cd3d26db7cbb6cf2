/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Stands before every kernel file: how a stack is read.
 *
 * A stack is bytes plus a table of rows: rows[z] = (offset of plane z, stride), both in bytes. Luma is read in DN of
 * 8 bits; with LUMA_BYTES = 2 from little-endian 16-bit samples, whose 65535 is 255 DN.
 */
#ifndef LUMA_BYTES
#define LUMA_BYTES 1
#endif

#define UNKNOWN_PLANE 255

inline float luma_at(__global const uchar *stack, ulong2 rows, int x, int y)
{
    __global const uchar *sample = stack + rows.x + rows.y * (ulong)y + (ulong)x * LUMA_BYTES;
#if LUMA_BYTES == 2
    return (float)(sample[0] | sample[1] << 8) * (255.0f / 65535.0f);
#else
    return (float)*sample;
#endif
}

/* Index i of n samples mirrored at the ends without repeating them: -1 is 1, n is n - 2. */
inline int mirror(int i, int n)
{
    i = abs(i);
    return i < n ? i : 2 * n - 2 - i;
}
