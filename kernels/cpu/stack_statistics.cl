/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * For CPUs, in one pass over the luma of all planes: the reference of reference_image.cl (the mean, rounded down) and
 * the moved pixels of z_entropy.cl. H is at most log2 of the bins between the darkest and the brightest plane, so that
 * the histogram is needed where these lie far apart only.
 */
#define BIN_SHIFT 5 /* 32 DN */
#define BINS 8
#define ROUNDING 1e-4f /* bits by which n_log2() may err */

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

/* Entropy of the histogram of 16 pixels along z, bits. */
inline float16 entropy(__global const uchar *stack, __global const ulong2 *rows, int x, int y, int planes)
{
    char16 count[BINS];
    __attribute__((opencl_unroll_hint))
    for (int bin = 0; bin < BINS; bin++)
        count[bin] = 0;
    for (int z = 0; z < planes; z++) {
        const uchar16 of_bin = *(__global const lanes8 *)(stack + rows[z].x + rows[z].y * (ulong)y + x) >> (uchar)BIN_SHIFT;
        __attribute__((opencl_unroll_hint))
        for (int bin = 0; bin < BINS; bin++)
            count[bin] -= of_bin == (uchar16)(uchar)bin;
    }
    float16 sum = 0.0f;
    __attribute__((opencl_unroll_hint))
    for (int bin = 0; bin < BINS; bin++)
        sum += n_log2(max(convert_float16(count[bin]), 1.0f));
    return log2((float)planes) - sum / planes;
}

/* One work-item a row. mean, moved: uchar[height][width]; moved is 255 where H > threshold_bits. */
__kernel void stack_statistics(__global const uchar *stack, __global const ulong2 *rows, __global uchar *mean,
                               __global uchar *moved, int width, int planes, float threshold_bits)
{
    const int y = (int)get_group_id(0);
    const uchar most_bins = (uchar)min(exp2(threshold_bits), (float)BINS);
    FOR_EACH_16(x, width)
    {
        ushort16 sum = 0;
        uchar16 darkest = 255, brightest = 0;
        for (int z = 0; z < planes; z++) {
            const uchar16 luma = *(__global const lanes8 *)(stack + rows[z].x + rows[z].y * (ulong)y + x);
            sum += convert_ushort16(luma);
            darkest = min(darkest, luma);
            brightest = max(brightest, luma);
        }
        const ulong pixel = (ulong)y * width + x;
        *(__global lanes8 *)(mean + pixel) = convert_uchar16(convert_float16(sum) * (1.0f / planes) + 1e-3f);

        const uchar16 bins = (brightest >> (uchar)BIN_SHIFT) - (darkest >> (uchar)BIN_SHIFT) + (uchar)1;
        uchar16 exceeds = 0;
        if (any(bins > most_bins))
            exceeds = as_uchar16(convert_char16(entropy(stack, rows, x, y, planes) > threshold_bits + ROUNDING));
        *(__global lanes8 *)(moved + pixel) = exceeds;
    }
}
