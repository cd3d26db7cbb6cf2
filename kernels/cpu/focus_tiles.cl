/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The focus measure of focus_measure.cl for CPUs: 16 lanes of 16-bit integers, one work-item a tile of the picture.
 * All planes of a tile are measured one after the other; the tile's luma, its coarse pictures and the best plane so
 * far stay in the core's cache. Luma has 8 bits.
 *
 * What differs from the formula:
 *  - the gradient's magnitude is max(m, 7/8 m + n/2) with m >= n the absolute derivatives: 3 % low to 0.8 % high;
 *  - gradients are integers in 1/8 DN (fine), 1/16 (1/2), 1/36 (1/3) and 1/4 DN (1/4);
 *  - R_{1/i} always averages i x i pixels and U_i spreads by i, so that at a size i does not divide the coarse picture
 *    is not stretched to the fine one;
 *  - beyond the border stands the fine picture, mirrored, at every level, which changes the outermost 2 LEVELS pixels;
 *  - the maximum has 8 bits of mantissa.
 */
#define TILE_WIDTH 384 /* multiples of 12, so that coarse samples belong to one tile */
#define TILE_HEIGHT 36
#define MARGIN_X 16 /* at least 2 LEVELS, whole lanes */
#define MARGIN_Y 8  /* at least 2 LEVELS */
#define STRIDE (TILE_WIDTH + 2 * MARGIN_X + 48)
#define COARSE_STRIDE (TILE_WIDTH / 2 + 32)
#define SPREAD_STRIDE (TILE_WIDTH + 48)
#define COARSE_ROWS (TILE_HEIGHT / 2 + 4)
#define SPREAD_LEVEL (COARSE_ROWS * SPREAD_STRIDE) /* samples */

/* The picture's part that a tile covers. */
typedef struct {
    int x, y;          /* the first pixel */
    int columns, rows; /* that lie in the picture */
} Tile;

/* Copies a plane's tile with its margins, mirrored at the picture's borders. */
inline void load_tile(__global const uchar *plane, ulong stride, Tile tile, int width, int height, uchar *luma)
{
    const int left = max(tile.x - MARGIN_X, 0), right = min(tile.x + TILE_WIDTH + MARGIN_X, width);
    const int end = tile.x + tile.columns + MARGIN_X;
    for (int y = -MARGIN_Y; y < (tile.rows + 11) / 12 * 12 + MARGIN_Y; y++) {
        __global const uchar *row = plane + stride * (ulong)mirror(tile.y + y, height);
        uchar *copy = luma + (y + MARGIN_Y) * STRIDE + MARGIN_X - tile.x;
        for (int x = left; x < right - 16; x += 16)
            *(lanes8 *)(copy + x) = *(__global const lanes8 *)(row + x);
        *(lanes8 *)(copy + right - 16) = *(__global const lanes8 *)(row + right - 16);
        for (int x = tile.x - MARGIN_X; x < 0; x++)
            copy[x] = copy[-x];
        for (int x = right; x < end; x++)
            copy[x] = copy[max(2 * width - 2 - x, left)];
    }
}

inline ushort16 magnitude(short16 dx, short16 dy)
{
    const short16 x = max(dx, -dx), y = max(dy, -dy);
    const short16 m = max(x, y), n = min(x, y);
    return as_ushort16(max(m, m - (m >> 3) + (n >> 1)));
}

/* Sums of LEVEL neighbours of a row, for 16 coarse samples. */
inline ushort16 sum_pairs(const ushort *row)
{
    const ushort16 a = *(const lanes16 *)row, b = *(const lanes16 *)(row + 16);
    return (ushort16)(a.even, b.even) + (ushort16)(a.odd, b.odd);
}

inline ushort16 sum_3(const ushort *row)
{
    return *(const lanes16 *)row + *(const lanes16 *)(row + 1) + *(const lanes16 *)(row + 2);
}

inline ushort16 sum_triples(const ushort *row)
{
    const ushort16 a = sum_3(row), b = sum_3(row + 16), c = sum_3(row + 32);
    return (ushort16)(a.s0369, a.scf, b.s258b, b.se, c.s147a, c.sd);
}

inline ushort16 sum_quadruples(const ushort *row)
{
    const ushort16 a = sum_pairs(row), b = sum_pairs(row + 32);
    return (ushort16)(a.even, b.even) + (ushort16)(a.odd, b.odd);
}

inline ushort16 sum_neighbours(const ushort *row, int level)
{
    return level == 2 ? sum_pairs(row) : level == 3 ? sum_triples(row) : sum_quadruples(row);
}

/* Sums of level x level pixels, from two coarse samples before the tile to two behind. */
inline void downsample(const uchar *luma, Tile tile, ushort *sums, int level)
{
    ushort row[STRIDE + 64];
    const int first = MARGIN_X - 2 * level;
    const int columns = (tile.columns + level - 1) / level + 4, rows = (tile.rows + level - 1) / level + 4;
    for (int r = 0; r < rows; r++) {
        const uchar *fine = luma + (MARGIN_Y + (r - 2) * level) * STRIDE;
        for (int x = 0; x < STRIDE; x += 16) {
            ushort16 sum = convert_ushort16(*(const lanes8 *)(fine + x));
            for (int k = 1; k < level; k++)
                sum += convert_ushort16(*(const lanes8 *)(fine + k * STRIDE + x));
            *(lanes16 *)(row + x) = sum;
        }
        for (int c = 0; c < columns; c += 16)
            *(lanes16 *)(sums + r * COARSE_STRIDE + c) = sum_neighbours(row + first + c * level, level);
    }
}

/* Weights of bilinear upsampling in 1/UNITS: the farther of two coarse samples weighs FAR, the nearer the rest. */
#define UNITS(level) ((level) % 2 ? (level) : 2 * (level))
#define FAR(level, phase) (abs(2 * (phase) + 1 - (level)) >> ((level) % 2))

/* Keeps UNITS^2 times the coarse gradient within 16 bits. */
#define GRADIENT_SHIFT(level) ((level) == 4 ? 5 : 1)

inline ushort16 interleave(ushort8 a, ushort8 b)
{
    ushort16 v;
    v.even = a;
    v.odd = b;
    return v;
}

/* One row of coarse gradients spread to the fine columns, in 1/UNITS. */
inline void spread_row(const ushort *gradient, ushort *fine, int columns, int level)
{
    for (int c = 0; c * level < columns; c += 16) {
        const ushort16 here = *(const lanes16 *)(gradient + c + 1);
        const ushort16 before = *(const lanes16 *)(gradient + c), after = *(const lanes16 *)(gradient + c + 2);
        lanes16 *out = (lanes16 *)(fine + c * level);
        if (level == 2) {
            const ushort16 a = here * (ushort)3 + before, b = here * (ushort)3 + after;
            out[0] = interleave(a.lo, b.lo);
            out[1] = interleave(a.hi, b.hi);
        } else if (level == 3) {
            const ushort16 a = here * (ushort)2 + before, b = here * (ushort)3, d = here * (ushort)2 + after;
            out[0] = (ushort16)(a.s0, b.s0, d.s0, a.s1, b.s1, d.s1, a.s2, b.s2, d.s2, a.s3, b.s3, d.s3, a.s4, b.s4,
                                d.s4, a.s5);
            out[1] = (ushort16)(b.s5, d.s5, a.s6, b.s6, d.s6, a.s7, b.s7, d.s7, a.s8, b.s8, d.s8, a.s9, b.s9, d.s9,
                                a.sa, b.sa);
            out[2] = (ushort16)(d.sa, a.sb, b.sb, d.sb, a.sc, b.sc, d.sc, a.sd, b.sd, d.sd, a.se, b.se, d.se, a.sf,
                                b.sf, d.sf);
        } else {
            const ushort16 a = here * (ushort)5 + before * (ushort)3, b = here * (ushort)7 + before;
            const ushort16 d = here * (ushort)7 + after, e = here * (ushort)5 + after * (ushort)3;
            const ushort16 ad = interleave(a.lo, d.lo), be = interleave(b.lo, e.lo);
            const ushort16 ad_hi = interleave(a.hi, d.hi), be_hi = interleave(b.hi, e.hi);
            out[0] = interleave(ad.lo, be.lo);
            out[1] = interleave(ad.hi, be.hi);
            out[2] = interleave(ad_hi.lo, be_hi.lo);
            out[3] = interleave(ad_hi.hi, be_hi.hi);
        }
    }
}

/* Gradients of a coarse picture, from one row before the tile to one behind, each spread to the fine columns. */
inline void coarse_gradient(const ushort *sums, Tile tile, ushort *spread, int level)
{
    ushort gradient[COARSE_STRIDE + 16];
    const int columns = (tile.columns + level - 1) / level + 2, rows = (tile.rows + level - 1) / level + 2;
    for (int r = 0; r < rows; r++) {
        for (int c = 0; c < columns; c += 16) {
            const short *above = (const short *)sums + r * COARSE_STRIDE + c;
            const short *here = above + COARSE_STRIDE, *below = here + COARSE_STRIDE;
            const short16 tl = *(const slanes16 *)above, tr = *(const slanes16 *)(above + 2);
            const short16 bl = *(const slanes16 *)below, br = *(const slanes16 *)(below + 2);
            const short16 l = *(const slanes16 *)here, r = *(const slanes16 *)(here + 2);
            const short16 t = *(const slanes16 *)(above + 1), b = *(const slanes16 *)(below + 1);
            const short16 dx = tr - tl + br - bl + ((r - l) << 1), dy = bl - tl + br - tr + ((b - t) << 1);
            *(lanes16 *)(gradient + c) = magnitude(dx, dy) >> (ushort)GRADIENT_SHIFT(level);
        }
        spread_row(gradient, spread + r * SPREAD_STRIDE, tile.columns, level);
    }
}

/* The two rows of spread gradients around a fine row, and their weights in 1/UNITS. */
typedef struct {
    int near_row, far_row;
    ushort near, far;
} Rows;

inline Rows rows_around(int y, int level)
{
    const int k = y / level, phase = y % level; /* of the row before; the sample's own row is k + 1 */
    Rows rows;
    rows.near_row = (k + 1) * SPREAD_STRIDE;
    rows.far_row = (2 * phase + 1 < level ? k : k + 2) * SPREAD_STRIDE;
    rows.far = (ushort)FAR(level, phase);
    rows.near = (ushort)(UNITS(level) - rows.far);
    return rows;
}

inline float16 upsample(const ushort *spread, const Rows *rows)
{
    const ushort16 near = *(const lanes16 *)(spread + rows->near_row), far = *(const lanes16 *)(spread + rows->far_row);
    return convert_float16(near * rows->near + far * rows->far);
}

/* What one unit of the integer product is worth in P. */
#define FINE_UNIT (1.0f / 8)
#define COARSE_UNIT(level) \
    ((float)(1 << GRADIENT_SHIFT(level)) / (8 * (level) * (level) * UNITS(level) * UNITS(level)))

/* The lowest bits of the best product so far hold LAST_PLANE - z. */
#define LAST_PLANE 63

/* Takes plane z of a tile into the best product and the sum over the planes. */
inline void measure_plane(const uchar *luma, Tile tile, const ushort *spread, const Rows (*rows)[TILE_HEIGHT], int z,
                          int *best, float *sum)
{
    for (int x = 0; x < tile.columns; x += 16) {
        short16 dx[2], smooth[2]; /* derivative along x and smoothing of the two rows before */
        for (int y = -1; y <= tile.rows; y++) {
            const uchar *row = luma + (y + MARGIN_Y) * STRIDE + MARGIN_X + x;
            const short16 l = convert_short16(*(const lanes8 *)(row - 1));
            const short16 c = convert_short16(*(const lanes8 *)row);
            const short16 r = convert_short16(*(const lanes8 *)(row + 1));
            const short16 dx_below = r - l, smooth_below = l + r + (c << 1);
            if (y > 0) {
                const int i = (y - 1) * TILE_WIDTH + x;
                float16 product = convert_float16(
                    magnitude(dx[0] + dx_below + (dx[1] << 1), smooth_below - smooth[0]));
                __attribute__((opencl_unroll_hint))
                for (int level = 2; level <= LEVELS; level++)
                    product *= upsample(spread + (level - 2) * SPREAD_LEVEL + x, &rows[level - 2][y - 1]);
                *(flanes *)(sum + i) += product;
                const int16 candidate = (as_int16(product) & ~LAST_PLANE) | (LAST_PLANE - z);
                *(ilanes *)(best + i) = max(*(ilanes *)(best + i), candidate);
            }
            dx[0] = dx[1];
            dx[1] = dx_below;
            smooth[0] = smooth[1];
            smooth[1] = smooth_below;
        }
    }
}

inline float sum_of_lanes(float16 v)
{
    const float8 a = v.lo + v.hi;
    const float4 b = a.lo + a.hi;
    const float2 c = b.lo + b.hi;
    return c.lo + c.hi;
}

/* Confidence of 16 pixels, of which `columns` lie in the picture. */
inline void store_confidence(float16 peak, float16 mean, int planes, __global uchar *confidence, int columns)
{
    const float16 above = select((float16)0.0f, 1.0f - mean / peak, peak > 0.0f);
    uchar lanes[16];
    *(lanes8 *)lanes = convert_uchar16(clamp(255.0f * above * planes / (planes - 1) + 0.5f, 0.0f, 255.0f));
    for (int i = 0; i < min(columns, 16); i++)
        confidence[i] = lanes[i];
}

/* One work-item a tile. peak[height][stride]: max_z P as the upper half of a float; peak_plane likewise: where it is,
 * UNKNOWN_PLANE where it is not `tolerance` times the mean over z; tile_sums: sum over a tile's pixels of the mean over
 * z. The stride is in pixels and holds whole lanes; peak is 0 behind the picture's columns. confidence[height][width]
 * as in sparse_depth.cl, if `with_confidence`. */
__kernel void focus_tiles(__global const uchar *stack, __global const ulong2 *table, __global ushort *peak,
                          __global uchar *peak_plane, __global float *tile_sums, __global uchar *confidence, int stride,
                          int width, int height, int planes, float tolerance, int with_confidence)
{
    uchar luma[(TILE_HEIGHT + 2 * MARGIN_Y) * STRIDE];
    ushort sums[COARSE_ROWS * COARSE_STRIDE];
    ushort spread[(LEVELS > 1 ? LEVELS - 1 : 1) * SPREAD_LEVEL];
    int best[TILE_HEIGHT * TILE_WIDTH];
    float sum[TILE_HEIGHT * TILE_WIDTH];

    Tile tile;
    tile.x = (int)get_group_id(0) * TILE_WIDTH;
    tile.y = (int)get_group_id(1) * TILE_HEIGHT;
    tile.columns = min(TILE_WIDTH, width - tile.x);
    tile.rows = min(TILE_HEIGHT, height - tile.y);

    Rows rows[LEVELS > 1 ? LEVELS - 1 : 1][TILE_HEIGHT];
    for (int level = 2; level <= LEVELS; level++)
        for (int y = 0; y < TILE_HEIGHT; y++)
            rows[level - 2][y] = rows_around(y, level);
    for (int i = 0; i < TILE_HEIGHT * TILE_WIDTH; i += 16) {
        *(ilanes *)(best + i) = 0;
        *(flanes *)(sum + i) = 0.0f;
    }
    for (int z = 0; z < planes; z++) {
        load_tile(stack + table[z].x, table[z].y, tile, width, height, luma);
        __attribute__((opencl_unroll_hint))
        for (int level = 2; level <= LEVELS; level++) {
            downsample(luma, tile, sums, level);
            coarse_gradient(sums, tile, spread + (level - 2) * SPREAD_LEVEL, level);
        }
        measure_plane(luma, tile, spread, rows, z, best, sum);
    }

    float unit = FINE_UNIT;
    __attribute__((opencl_unroll_hint))
    for (int level = 2; level <= LEVELS; level++)
        unit *= COARSE_UNIT(level);
    float16 total = 0.0f;
    for (int y = 0; y < tile.rows; y++)
        for (int x = 0; x < tile.columns; x += 16) {
            const ulong pixel = (ulong)(tile.y + y) * stride + tile.x + x;
            const int16 bits = *(ilanes *)(best + y * TILE_WIDTH + x);
            const int16 inside = LANE < tile.columns - x;
            const float16 p = as_float16(bits & ~LAST_PLANE & inside) * unit;
            const float16 mean = as_float16(*(ilanes *)(sum + y * TILE_WIDTH + x) & inside) * (unit / planes);
            const int16 plane = LAST_PLANE - (bits & LAST_PLANE);
            const int16 sharp = p >= tolerance * mean;
            total += mean;
            *(__global lanes16 *)(peak + pixel) = convert_ushort16(as_uint16(p) >> 16);
            *(__global lanes8 *)(peak_plane + pixel) = convert_uchar16(select((int16)UNKNOWN_PLANE, plane, sharp));
            if (with_confidence)
                store_confidence(p, mean, planes, confidence + (ulong)(tile.y + y) * width + tile.x + x,
                                 tile.columns - x);
        }
    tile_sums[get_group_id(1) * get_num_groups(0) + get_group_id(0)] = sum_of_lanes(total);
}
