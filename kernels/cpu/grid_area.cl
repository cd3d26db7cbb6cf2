/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The part of the picture under a column of luma_grid.cl's grid, in strips 16 pixels wide, four rows a vector: steps of
 * luma, those of known pixels, and places in half planes. What fills the last vector counts nowhere.
 */
#define STRIPS ((SIGMA_XY + 15) / 16)
#define STRIP_VECTORS ((SIGMA_XY + 3) / 4)
#define VECTORS (STRIPS * STRIP_VECTORS)
#if SIGMA_XY <= 32
#define UNROLL_STRIP __attribute__((opencl_unroll_hint))
#else
#define UNROLL_STRIP
#endif
#define AHEAD 256   /* columns asked for ahead */
#define OUTSIDE 255 /* not a step of luma, whose least size is 4 */
typedef struct {
    uchar64 steps[VECTORS], known_steps[VECTORS], places[VECTORS];
    int first, last; /* steps among them */
} Area;

typedef ushort __attribute__((ext_vector_type(64))) ushort64;

/* 255 where it is so. */
INLINE uchar64 equal(uchar64 a, uchar64 b)
{
    return __builtin_astype(a == b, uchar64);
}

/* 16 columns of four rows from `top` on, the last one again instead of those from `bottom` on. */
INLINE uchar64 four_rows(__global const uchar *picture, int x, int top, int bottom, int width)
{
    uchar16 rows[4];
    __attribute__((opencl_unroll_hint))
    for (int i = 0; i < 4; i++) {
        __global const uchar *row = picture + (ulong)min(top + i, bottom - 1) * width + x;
        PREFETCH(row + AHEAD);
        rows[i] = *(__global const lanes8 *)row;
    }
    return (uchar64)(rows[0], rows[1], rows[2], rows[3]);
}

INLINE void load_area(__global const uchar *sparse, __global const uchar *luma, int left, int top, int width,
                      int height, Area *area)
{
    const int right = min(left + SIGMA_XY, width), bottom = min(top + SIGMA_XY, height);
    uchar64 least = OUTSIDE, most = 0;
    for (int i = 0; i < VECTORS; i++) {
        const int x = left + i / STRIP_VECTORS * 16, y = top + i % STRIP_VECTORS * 4;
        const int first = min(x, width - 16); /* at the right border the lanes before come along */
        const char16 column = convert_char16(LANE) + (char)(first - x);
        const uchar16 beside = as_uchar16(column < (char)0 || column >= (char)clamp(right - x, 0, 16));
        const uchar16 none = OUTSIDE;
        const uchar64 outside = (uchar64)(y < bottom ? beside : none, y + 1 < bottom ? beside : none,
                                          y + 2 < bottom ? beside : none, y + 3 < bottom ? beside : none);

        const uchar64 pixels = four_rows(luma, first, min(y, bottom - 1), bottom, width);
        const uchar64 places = four_rows(sparse, first, min(y, bottom - 1), bottom, width);
        const uchar64 step = __builtin_convertvector(
            __builtin_convertvector(pixels, ushort64) / (ushort)SIGMA_LUMA, uchar64);
        const uchar64 inside = step & ~outside;
        area->steps[i] = step | outside;
        area->known_steps[i] = step | outside | equal(places, UNKNOWN_PLANE);
        area->places[i] = places;
        least = area->steps[i] < least ? area->steps[i] : least;
        most = inside > most ? inside : most;
    }
    area->first = least_of(least);
    area->last = most_of(most);
}

/* Pixels of an area in a step of luma, known ones, and the sum of their places. (Compilers count the bits of truth
 * values.) */
INLINE uint3 count_step(const Area *area, uchar step)
{
    uint3 count = 0;
    for (int i = 0; i < VECTORS; i += STRIP_VECTORS) {
        uchar64 sums = 0;
        UNROLL_STRIP
        for (int j = 0; j < STRIP_VECTORS; j++) {
            const uchar64 tells = equal(area->known_steps[i + j], step);
            count.x += sum_of_bytes(equal(area->steps[i + j], step) & (uchar)1);
            count.y += sum_of_bytes(tells & (uchar)1);
            sums += tells & area->places[i + j];
            if (j % 2 == 1 || j == STRIP_VECTORS - 1) { /* places are below 128: two fit a byte */
                count.z += sum_of_bytes(sums);
                sums = 0;
            }
        }
    }
    return count;
}
