/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * What kernels of light fields that compute 16 pixels in step have in common.
 */
typedef uint16 __attribute__((aligned(4))) uint16_any;

#define LANES16 (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#define OPAQUE 0xff000000u

/* Reads from[i] for each lane of i. */
#define GATHER(type, from, i) \
    (type)(from[i.s0], from[i.s1], from[i.s2], from[i.s3], from[i.s4], from[i.s5], from[i.s6], from[i.s7], from[i.s8], \
           from[i.s9], from[i.sa], from[i.sb], from[i.sc], from[i.sd], from[i.se], from[i.sf])

typedef ulong __attribute__((aligned(4))) ulong_any;

/* Reads from[i] and from[i + 1] for each lane of i: one load fetches both. */
INLINE void gather_pairs(__global const float *from, int16 i, float16 *first, float16 *second)
{
#define PAIR(lane) (*(__global const ulong_any *)(from + (lane)))
    const float16 low = as_float16((ulong8)(PAIR(i.s0), PAIR(i.s1), PAIR(i.s2), PAIR(i.s3), PAIR(i.s4), PAIR(i.s5), PAIR(i.s6),
                                            PAIR(i.s7)));
    const float16 high = as_float16((ulong8)(PAIR(i.s8), PAIR(i.s9), PAIR(i.sa), PAIR(i.sb), PAIR(i.sc), PAIR(i.sd), PAIR(i.se),
                                             PAIR(i.sf)));
    *first = (float16)(low.even, high.even);
    *second = (float16)(low.odd, high.odd);
}

/* The greatest of each lane and those before it. */
inline int16 greatest_so_far(int16 lanes)
{
    lanes = max(lanes, lanes.s00123456789abcde);
    lanes = max(lanes, lanes.s010123456789abcd);
    lanes = max(lanes, lanes.s01230123456789ab);
    return max(lanes, lanes.s0123456701234567);
}

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
    for (int i = 0; i < count; i++) {
        const uchar4 color = as_uchar4(EACH(const uint, colors)[i]);
        __global uchar *pixel = line + channels * (x + i);
        pixel[0] = color.x;
        pixel[1] = color.y;
        pixel[2] = color.z;
        if (channels == 4)
            pixel[3] = color.w;
    }
}
