/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * What rays that are followed 16 in step have in common.
 */
typedef uint16 __attribute__((aligned(4))) uint16_any;

#define LANES16 (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#define OPAQUE 0xff000000u

/* Reads from[i] for each lane of i. */
#define GATHER(type, from, i) \
    (type)(from[i.s0], from[i.s1], from[i.s2], from[i.s3], from[i.s4], from[i.s5], from[i.s6], from[i.s7], from[i.s8], \
           from[i.s9], from[i.sa], from[i.sb], from[i.sc], from[i.sd], from[i.se], from[i.sf])

/* The lanes of a variable as an array. */
#define EACH(type, lanes) ((type *)&(lanes))

/* The byte of packed pixels at `shift` bits. */
inline float16 channel_of(uint16 pixels, int shift)
{
    return convert_float16(convert_int16(pixels >> shift & 255));
}

/* Writes the first `count` of 16 pixels from x on. */
inline void put_colors(__global uchar *line, int x, int count, int channels, uint16 colors)
{
    if (channels == 4 && count == 16) {
        *(__global uint16_any *)(line + 4 * x) = colors;
        return;
    }
    for (int i = 0; i < count; i++)
        put_color(line + channels * (x + i), channels, convert_float4(as_uchar4(EACH(const uint, colors)[i])));
}
