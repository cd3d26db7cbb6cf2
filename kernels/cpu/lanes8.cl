/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * What rays that are followed 8 in step have in common.
 */
typedef uint8 __attribute__((aligned(4))) uint8_any;

#define LANES8 (float8)(0, 1, 2, 3, 4, 5, 6, 7)
#define OPAQUE 0xff000000u

/* Reads from[i] for each lane of i. */
#define GATHER(type, from, i) \
    (type)(from[i.s0], from[i.s1], from[i.s2], from[i.s3], from[i.s4], from[i.s5], from[i.s6], from[i.s7])

/* The lanes of a variable as an array. */
#define EACH(type, lanes) ((type *)&(lanes))

/* The byte of packed pixels at `shift` bits. */
inline float8 channel_of(uint8 pixels, int shift)
{
    return convert_float8(convert_int8(pixels >> shift & 255));
}

/* Writes the first `count` of 8 pixels from x on. */
inline void put_colors(__global uchar *line, int x, int count, int channels, uint8 colors)
{
    if (channels == 4 && count == 8) {
        *(__global uint8_any *)(line + 4 * x) = colors;
        return;
    }
    for (int i = 0; i < count; i++)
        put_color(line + channels * (x + i), channels, convert_float4(as_uchar4(EACH(const uint, colors)[i])));
}
