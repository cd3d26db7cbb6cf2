/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * For focus_tiles.cl, in one pass over a tile's luma in all planes, which the core's cache still holds: the reference of
 * reference_image.cl (the mean, rounded down) and the moved pixels of z_entropy.cl. H is at most log2 of the bins
 * between the darkest and the brightest plane, so that the histogram is needed where these lie far apart only.
 */
#define BIN_SHIFT 4 /* 16 DN */
#define BINS 16
#define MOST_PLANES 64
#define ROUNDING 1e-4f /* bits by which n_log2() may err */
#define ROWS_AHEAD 3   /* rows */

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

/* Which of 16 pixels moved, 255 each, among the `candidates`: H = log2 N - 1/N sum of n log2 n over the bins with n of
 * the N planes is above the threshold where that sum is below `least`. */
inline uchar16 moves(__global const uchar *stack, const ulong *starts, int x, int planes, float least,
                     uchar16 candidates)
{
    uchar16 bins[MOST_PLANES], first = 255, last = 0;
    for (int z = 0; z < planes; z++) {
        bins[z] = *(__global const lanes8 *)(stack + starts[z] + x) >> (uchar)BIN_SHIFT;
        first = min(first, bins[z]);
        last = max(last, bins[z]);
    }
    float16 sum = 0.0f;
    const int end = most_of(last & candidates);
    for (int bin = least_of(first | ~candidates); bin <= end; bin++) {
        uchar16 count = 0;
        for (int z = 0; z < planes; z++)
            count -= as_uchar16(bins[z] == (uchar16)(uchar)bin);
        sum += n_log2(max(convert_float16(count), 1.0f));
    }
    return as_uchar16(convert_char16(sum < least)) & candidates;
}

/* Which of 64 pixels moved, among those whose byte of `candidates` is 255. */
inline void mark_moved(__global const uchar *stack, const ulong *starts, int x, int planes, float least,
                       const uchar *candidates, __global uchar *moved)
{
    for (int i = 0; i < 64; i += 16) {
        const uchar16 c = *(const lanes8 *)(candidates + i);
        if (any(as_char16(c)))
            *(__global lanes8 *)(moved + i) = moves(stack, starts, x + i, planes, least, c);
    }
}

/* 32 sums of planes divided by their number. */
inline ushort32 mean_of(ushort32 sums, int planes)
{
    const int16 even = convert_int16(even_lanes(sums) * (1.0f / planes) + 1e-3f);
    const int16 odd = convert_int16(odd_lanes(sums) * (1.0f / planes) + 1e-3f);
    return as_ushort32(even | odd << 16);
}

/* Statistics of 64 pixels; mean and moved point at the first. */
inline void statistics_of_64(__global const uchar *stack, const ulong *starts, int x, int planes, float least,
                             uchar most_bins, __global uchar *mean, __global uchar *moved)
{
    ushort32 even = 0, odd = 0;
    uchar64 darkest = 255, brightest = 0;
    for (int z = 0; z < planes; z++) {
        const uchar64 luma = *(__global const bytes64 *)(stack + starts[z] + x);
        even += even_bytes(as_ushort32(luma));
        odd += odd_bytes(as_ushort32(luma));
        darkest = luma < darkest ? luma : darkest;
        brightest = luma > brightest ? luma : brightest;
    }
    *(__global byte_pairs *)mean = mean_of(even, planes) | mean_of(odd, planes) << (ushort)8;
    *(__global bytes64 *)moved = 0;

    const uchar64 bins_between = (brightest >> (uchar)BIN_SHIFT) - (darkest >> (uchar)BIN_SHIFT);
    const ulong8 candidates = __builtin_astype(bins_between >= most_bins, ulong8);
    if (any(as_long8(candidates) != 0))
        mark_moved(stack, starts, x, planes, least, (const uchar *)&candidates, moved);
}

/* mean, moved: uchar[height][width]; moved is 255 where H > threshold_bits. The rows they are written to are asked for
 * ahead as well. A last tile of less than 64 columns is left
 * to the one before. */
inline void tile_statistics(__global const uchar *stack, __global const ulong2 *rows, Tile tile, __global uchar *mean,
                            __global uchar *moved, int width, int planes, float threshold_bits)
{
    const int end = tile.x + TILE_WIDTH + 64 <= width ? tile.x + TILE_WIDTH : width;
    if (end - tile.x < 64)
        return;
    const uchar most_bins = (uchar)min(exp2(threshold_bits), (float)BINS);
    const float least = planes * (log2((float)planes) - threshold_bits - ROUNDING);
    ulong starts[MOST_PLANES];
    for (int y = tile.y; y < tile.y + tile.rows; y++) {
        for (int z = 0; z < planes; z++)
            starts[z] = rows[z].x + rows[z].y * (ulong)y;
        for (int block = tile.x; block < end; block += 64) {
            const int x = min(block, end - 64);
            const ulong pixel = (ulong)y * width + x;
            PREFETCH(mean + pixel + ROWS_AHEAD * width);
            PREFETCH(moved + pixel + ROWS_AHEAD * width);
            statistics_of_64(stack, starts, x, planes, least, most_bins, mean + pixel, moved + pixel);
        }
    }
}
