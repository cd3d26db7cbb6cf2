/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * For focus_tiles.cl: Sobel's filter, and the pictures of lower resolution under a tile, whose gradients are spread to
 * the fine pixels. Units and layout stand there.
 */
/* max(m, m - m/8 + n/2). */
inline ushort32 magnitude(short32 dx, short32 dy)
{
    const short32 x = higher(dx, -dx), y = higher(dy, -dy);
    const ushort32 m = as_ushort32(higher(x, y)), n = as_ushort32(lower(x, y));
    const ushort32 half_n = n >> (ushort)1, eighth_m = m >> (ushort)3;
    return m + ((half_n > eighth_m ? half_n : eighth_m) - eighth_m);
}

/* What Sobel's filter keeps of the two rows above, for 32 columns. */
typedef struct {
    short32 dx, dx_pair; /* derivative along x, and its sum over both rows */
    short32 smooth[2];   /* smoothing along x */
} Above;

/* The gradient around the row above, from the row at hand: its derivative and its smoothing along x. */
inline ushort32 next_gradient(short32 dx, short32 smooth, Above *above)
{
    const short32 dx_pair = above->dx + dx;
    const ushort32 gradient = magnitude(above->dx_pair + dx_pair, smooth - above->smooth[0]);
    above->dx = dx;
    above->dx_pair = dx_pair;
    above->smooth[0] = above->smooth[1];
    above->smooth[1] = smooth;
    return gradient;
}

/* Sums of neighbours, for 32 coarse samples. */
inline ushort32 sum_pairs(const uchar *row)
{
    const ushort32 pairs = *(const byte_pairs *)row;
    return even_bytes(pairs) + odd_bytes(pairs);
}

inline ushort32 sum_3(const ushort *row)
{
    return *(const lanes32 *)row + *(const lanes32 *)(row + 1) + *(const lanes32 *)(row + 2);
}

/* Indices of a shuffle: `of` each lane. */
#define LANES_4(of, i) of((i)), of((i) + 1), of((i) + 2), of((i) + 3)
#define LANES_8(of, i) LANES_4(of, i), LANES_4(of, (i) + 4)
#define LANES(of) LANES_8(of, 0), LANES_8(of, 8), LANES_8(of, 16), LANES_8(of, 24)

/* Every third of 96 lanes: 22 of the first two vectors, 10 of the last. */
#define THIRD_OF_A_B(i) ((i) < 22 ? 3 * (i) : 0)
#define THIRD_OF_AB_C(i) ((i) < 22 ? (i) : 3 * (i) - 32)

inline ushort32 sum_triples(const ushort *row)
{
    const ushort32 a = sum_3(row), b = sum_3(row + 32), c = sum_3(row + 64);
    const ushort32 ab = __builtin_shufflevector(a, b, LANES(THIRD_OF_A_B));
    return __builtin_shufflevector(ab, c, LANES(THIRD_OF_AB_C));
}

/* 16 sums of 4 x 4 pixels. */
inline ushort16 sum_quadruples(const uchar *row)
{
    const uint16 pairs = as_uint16(sum_pairs(row) + sum_pairs(row + STRIDE) + sum_pairs(row + 2 * STRIDE) +
                                   sum_pairs(row + 3 * STRIDE));
    return convert_ushort16((pairs & 65535u) + (pairs >> 16));
}

inline ushort32 sum_3_rows(const uchar *row)
{
    return widen(*(const bytes32 *)row) + widen(*(const bytes32 *)(row + STRIDE)) +
           widen(*(const bytes32 *)(row + 2 * STRIDE));
}

/* Sums of level x level pixels, from two coarse samples before the tile to two behind. */
inline void downsample(const uchar *luma, Tile tile, ushort *sums, int level)
{
    SCRATCH ushort row[STRIDE];
    const int columns = (tile.columns + level - 1) / level + 4, rows = tile.whole_rows / level + 4;
    for (int r = 0; r < rows; r++) {
        const uchar *fine = luma + (MARGIN_Y + (r - 2) * level) * STRIDE + ORIGIN - 2 * level;
        ushort *out = sums + r * COARSE_STRIDE;
        if (level == 2) {
            for (int c = 0; c < columns; c += 32)
                *(ushort32 *)(out + c) = sum_pairs(fine + 2 * c) + sum_pairs(fine + STRIDE + 2 * c);
        } else if (level == 3) {
            for (int x = 0; x < 3 * columns; x += 32)
                *(ushort32 *)(row + x) = sum_3_rows(fine + x);
            for (int c = 0; c < columns; c += 32)
                *(ushort32 *)(out + c) = sum_triples(row + 3 * c);
        } else {
            for (int c = 0; c < columns; c += 16)
                *(ushort16 *)(out + c) = sum_quadruples(fine + 4 * c);
        }
    }
}

/* Weights of bilinear upsampling in 1/UNITS: the farther of two coarse samples weighs FAR, the nearer the rest. */
#define UNITS(level) ((level) % 2 ? (level) : 2 * (level))
#define FAR(level, phase) (abs(2 * (phase) + 1 - (level)) >> ((level) % 2))

typedef struct {
    ushort32 even, odd; /* columns */
} Columns;

/* Of the samples from one before a block's first on, the nearest to a column and the one that weighs 1 beside its 2;
 * the block begins PHASE columns after its first sample does. */
#define NEAR(column) (1 + (column) / 3)
#define FAR_OR_NEAR(column) ((column) / 3 + (column) % 3)
#define EVEN_NEAR(i) NEAR(PHASE + 2 * (i))
#define EVEN_FAR(i) FAR_OR_NEAR(PHASE + 2 * (i))
#define ODD_NEAR(i) NEAR(PHASE + 2 * (i) + 1)
#define ODD_FAR(i) FAR_OR_NEAR(PHASE + 2 * (i) + 1)
#define SPREAD_BY(v, near, far) \
    __builtin_shufflevector(v, v, LANES(near)) * (ushort)2 + __builtin_shufflevector(v, v, LANES(far))

inline Columns spread_triples(ushort32 v, int phase)
{
    switch (phase) {
#define PHASE 0
    case PHASE:
        return (Columns){SPREAD_BY(v, EVEN_NEAR, EVEN_FAR), SPREAD_BY(v, ODD_NEAR, ODD_FAR)};
#undef PHASE
#define PHASE 1
    case PHASE:
        return (Columns){SPREAD_BY(v, EVEN_NEAR, EVEN_FAR), SPREAD_BY(v, ODD_NEAR, ODD_FAR)};
#undef PHASE
#define PHASE 2
    default:
        return (Columns){SPREAD_BY(v, EVEN_NEAR, EVEN_FAR), SPREAD_BY(v, ODD_NEAR, ODD_FAR)};
#undef PHASE
    }
}

/* A row of coarse gradients spread to the fine columns of a block, in 1/UNITS. */
inline void spread_row(const ushort *first, float16 *out, int block, int level)
{
    Columns spread;
    if (level == 2) {
        const ushort32 here = *(const lanes32 *)(first + 1) * (ushort)3;
        spread = (Columns){here + *(const lanes32 *)first, here + *(const lanes32 *)(first + 2)};
    } else {
        spread = spread_triples(*(const lanes32 *)first, block % 3);
    }
    out[0] = even_lanes(spread.even);
    out[1] = even_lanes(spread.odd);
    out[2] = odd_lanes(spread.even);
    out[3] = odd_lanes(spread.odd);
}

/* The same at level 4, where the columns of a vector share their phase. */
inline void spread_row_of_quarters(const ushort *first, float16 *out)
{
    const float16 before = convert_float16(*(const lanes16 *)first);
    const float16 here = convert_float16(*(const lanes16 *)(first + 1));
    const float16 after = convert_float16(*(const lanes16 *)(first + 2));
    out[0] = here * 5.0f + before * 3.0f;
    out[1] = here * 7.0f + before;
    out[2] = here * 7.0f + after;
    out[3] = here * 5.0f + after * 3.0f;
}

/* Gradients of a coarse picture, from one sample before the tile to one behind. */
inline void coarse_gradient(const ushort *sums, Tile tile, ushort *gradient, int level)
{
    const int columns = (tile.columns + level - 1) / level + 2, rows = tile.whole_rows / level + 2;
    for (int c = 0; c < columns; c += 32) {
        Above above = {0, 0, {0, 0}};
        for (int r = -2; r < rows; r++) {
            const short *row = (const short *)sums + (r + 2) * COARSE_STRIDE + c;
            const short32 left = *(const slanes32 *)row, centre = *(const slanes32 *)(row + 1);
            const short32 right = *(const slanes32 *)(row + 2);
            const ushort32 g = next_gradient(right - left, left + right + (centre << (short)1), &above);
            if (r >= 0)
                *(ushort32 *)(gradient + r * COARSE_STRIDE + c) = g;
        }
    }
}

/* The two coarse rows that a fine row lies between, spread to the columns of a block; and the samples of the next. */
typedef struct {
    float16 above[4], below[4];
    const ushort *next;
} Between;

inline void next_coarse_row(Between *rows, int block, int level)
{
    __attribute__((opencl_unroll_hint))
    for (int i = 0; i < 4; i++)
        rows->above[i] = rows->below[i];
    if (level == 4)
        spread_row_of_quarters(rows->next, rows->below);
    else
        spread_row(rows->next, rows->below, block, level);
    rows->next += COARSE_STRIDE;
}

/* The coarse rows that a block's first row lies between. */
inline Between first_coarse_rows(const ushort *gradient, int block, int level)
{
    Between rows;
    rows.next = gradient + block * BLOCK / level;
    next_coarse_row(&rows, block, level);
    next_coarse_row(&rows, block, level);
    return rows;
}

/* The fine row, counted from a coarse row's first, from which on the coarse rows below lie nearer to the next one. */
#define LOWER_HALF(level) (((level) + 1) / 2)

/* The spread gradient in the columns x % 4 = i of the fine row `phase` of a coarse row. */
inline float16 upsample(const Between *rows, int i, int phase, int level)
{
    const float far = FAR(level, phase), near = UNITS(level) - far;
    const bool lower = phase >= LOWER_HALF(level);
    const float16 here = lower ? rows->above[i] : rows->below[i], there = lower ? rows->below[i] : rows->above[i];
    return far == 0.0f ? here * near : here * near + there * far;
}
