/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * For CPUs, in one pass over the luma of all planes: the reference of reference_image.cl (the mean, rounded down) and
 * the moved pixels of z_entropy.cl. H is at most log2 of the bins between the darkest and the brightest plane, so that
 * the histogram is needed where these lie far apart only.
 */
#include "lanes32.cl"

#define BIN_SHIFT 4 /* 16 DN */
#define BINS 16
#define MOST_PLANES 64
#define ROUNDING 1e-4f /* bits by which n_log2() may err */

inline int lowest(uchar16 v)
{
    const uchar8 a = min(v.lo, v.hi);
    const uchar4 b = min(a.lo, a.hi);
    const uchar2 c = min(b.lo, b.hi);
    return min(c.lo, c.hi);
}

inline int highest(uchar16 v)
{
    return 255 - lowest(~v);
}

/* n log2 n of whole numbers 1..64, to 2e-4: exponent plus a polynomial of the mantissa m in [1, 2). (log2() takes the
 * lanes one by one.) */
inline float16 n_log2(float16 n)
{
    const int16 bits = as_int16(n);
    const float16 m = as_float16((bits & 0x007fffff) | 0x3f800000) - 1.0f;
    const float16 log_m = m * (1.4425018f + m * (-0.7176700f + m * (0.4557525f + m * (-0.2748533f + m * (0.1194024f +
                          m * -0.0251334f)))));
    return n * (convert_float16((bits >> 23) - 127) + log_m);
}

/* Entropy along z of 16 pixels whose planes fall in the bins from `first` to `last`, bits. */
inline float16 entropy(const uchar16 *bins, int planes, int first, int last)
{
    float16 sum = 0.0f;
    for (int bin = first; bin <= last; bin++) {
        char16 count = 0;
        for (int z = 0; z < planes; z++)
            count -= bins[z] == (uchar16)(uchar)bin;
        sum += n_log2(max(convert_float16(count), 1.0f));
    }
    return log2((float)planes) - sum / planes;
}

/* Which of 16 pixels moved, 255 each. */
inline uchar16 entropy_exceeds(__global const uchar *stack, __global const ulong2 *rows, int x, int y, int planes,
                               float threshold_bits)
{
    uchar16 bins[MOST_PLANES], first = 255, last = 0;
    for (int z = 0; z < planes; z++) {
        bins[z] = *(__global const lanes8 *)(stack + rows[z].x + rows[z].y * (ulong)y + x) >> (uchar)BIN_SHIFT;
        first = min(first, bins[z]);
        last = max(last, bins[z]);
    }
    return as_uchar16(convert_char16(entropy(bins, planes, lowest(first), highest(last)) > threshold_bits + ROUNDING));
}

inline uchar16 mean_of(ushort16 sum, int planes)
{
    return convert_uchar16(convert_float16(sum) * (1.0f / planes) + 1e-3f);
}

/* One work-item a row. mean, moved: uchar[height][width]; moved is 255 where H > threshold_bits. */
__kernel void stack_statistics(__global const uchar *stack, __global const ulong2 *rows, __global uchar *mean,
                               __global uchar *moved, int width, int planes, float threshold_bits)
{
    const int y = (int)get_group_id(0);
    const uchar most_bins = (uchar)min(exp2(threshold_bits), (float)BINS);
    FOR_EACH_32(x, width)
    {
        ushort32 sum = 0;
        uchar32 darkest = 255, brightest = 0;
        for (int z = 0; z < planes; z++) {
            const uchar32 luma = *(__global const bytes32 *)(stack + rows[z].x + rows[z].y * (ulong)y + x);
            sum += widen(luma);
            darkest = luma < darkest ? luma : darkest;
            brightest = luma > brightest ? luma : brightest;
        }
        const ulong pixel = (ulong)y * width + x;
        *(__global lanes8 *)(mean + pixel) = mean_of(first_half(sum), planes);
        *(__global lanes8 *)(mean + pixel + 16) = mean_of(second_half(sum), planes);

        uchar bins_between[32];
        *(bytes32 *)bins_between = (brightest >> (uchar)BIN_SHIFT) - (darkest >> (uchar)BIN_SHIFT);
        for (int i = 0; i < 32; i += 16) {
            uchar16 exceeds = 0;
            if (any(*(const lanes8 *)(bins_between + i) >= (uchar16)most_bins))
                exceeds = entropy_exceeds(stack, rows, x + i, y, planes, threshold_bits);
            *(__global lanes8 *)(moved + pixel + i) = exceeds;
        }
    }
}
