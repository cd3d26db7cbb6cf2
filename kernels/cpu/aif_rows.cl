/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The all-in-focus picture of aif.cl for CPUs, samples of 8 bits, 16 at once. What differs: positions are counted in
 * 1/256 plane, which moves a sample by at most 1/512 of what it changes from one plane to the next.
 */
#include "../noise_type.cl"
#define UNIT 256 /* positions a plane */
#define NO_POSITION 65535

inline ushort lowest(ushort16 v)
{
    const ushort8 a = min(v.lo, v.hi);
    const ushort4 b = min(a.lo, a.hi);
    const ushort2 c = min(b.lo, b.hi);
    return min(c.lo, c.hi);
}

inline ushort highest(ushort16 v)
{
    const ushort8 a = max(v.lo, v.hi);
    const ushort4 b = max(a.lo, a.hi);
    const ushort2 c = max(b.lo, b.hi);
    return max(c.lo, c.hi);
}

/* Positions of 16 depth pixels. With `scale` above 0 a pixel d means scale (d - 1), otherwise it is looked up. */
inline ushort16 positions_of(ushort16 depth, __global const ushort *positions, float scale)
{
    if (scale > 0.0f) {
        const ushort16 position = convert_ushort16(convert_float16(depth) * scale + (0.5f - scale));
        return depth == (ushort16)0 ? (ushort16)NO_POSITION : position;
    }
    ushort lanes[16];
    *(lanes16 *)lanes = depth;
    for (int i = 0; i < 16; i++)
        lanes[i] = positions[lanes[i]];
    return *(lanes16 *)lanes;
}

/* Mean of four positions over those that are known. */
inline ushort16 mean_of_known(ushort16 a, ushort16 b, ushort16 c, ushort16 d)
{
    const uint16 none = (uint16)NO_POSITION;
    const uint16 p = convert_uint16(a), q = convert_uint16(b), r = convert_uint16(c), s = convert_uint16(d);
    const uint16 sum = (p == none ? 0 : p) + (q == none ? 0 : q) + (r == none ? 0 : r) + (s == none ? 0 : s);
    const int16 known = -((p != none) + (q != none) + (r != none) + (s != none));
    const float16 mean = convert_float16(sum) / convert_float16(max(known, 1)) + 0.5f;
    return convert_ushort16(known == 0 ? none : convert_uint16(mean));
}

/* Positions of 16 chroma samples from x on, between two rows of depth pixels; at odd sizes the last stands twice. */
inline ushort16 chroma_positions(__global const ushort *above, __global const ushort *below, int x, int width,
                                 __global const ushort *positions, float scale)
{
    ushort rows[2][32];
    for (int i = 0; i < 32; i += 16) {
        if (2 * x + i + 16 <= width) {
            *(lanes16 *)(rows[0] + i) = *(__global const lanes16 *)(above + 2 * x + i);
            *(lanes16 *)(rows[1] + i) = *(__global const lanes16 *)(below + 2 * x + i);
        } else
            for (int j = i; j < i + 16; j++) {
                rows[0][j] = above[min(2 * x + j, width - 1)];
                rows[1][j] = below[min(2 * x + j, width - 1)];
            }
    }
    const ushort16 a = positions_of(*(lanes16 *)rows[0], positions, scale);
    const ushort16 b = positions_of(*(lanes16 *)(rows[0] + 16), positions, scale);
    const ushort16 c = positions_of(*(lanes16 *)rows[1], positions, scale);
    const ushort16 d = positions_of(*(lanes16 *)(rows[1] + 16), positions, scale);
    return mean_of_known((ushort16)(a.even, b.even), (ushort16)(a.odd, b.odd), (ushort16)(c.even, d.even),
                         (ushort16)(c.odd, d.odd));
}

/* Positions of the part-th 16 samples of 16 pixels with interleaved channels. */
inline ushort16 positions_of_samples(ushort16 p, int channels, int part)
{
    switch (channels) {
    case 2:
        return part == 0 ? p.s0011223344556677 : p.s8899aabbccddeeff;
    case 3:
        return part == 0 ? p.s0001112223334445 : part == 1 ? p.s55666777888999aa : p.sabbbcccdddeeefff;
    case 4:
        return part == 0 ? p.s0000111122223333
             : part == 1 ? p.s4444555566667777
             : part == 2 ? p.s88889999aaaabbbb
                         : p.sccccddddeeeeffff;
    default:
        return p;
    }
}

typedef struct {
    __global const uchar *stack;
    __global const ulong2 *rows; /* of the component's planes */
    int planes;
} Source;

inline uchar16 samples_at(const Source *source, int z, int x, int y)
{
    return *(__global const lanes8 *)(source->stack + source->rows[z].x + source->rows[z].y * (ulong)y + x);
}

inline uchar16 mean_samples(const Source *source, int x, int y)
{
    ushort16 sum = 0;
    for (int z = 0; z < source->planes; z++)
        sum += convert_ushort16(samples_at(source, z, x, y));
    return convert_uchar16(convert_float16(sum) / source->planes + 0.5f);
}

/* Between the two planes around each position: planes first to last hold them all. */
inline uchar16 linear_samples(const Source *source, int x, int y, ushort16 position, int first, int last)
{
    ushort16 sum = UNIT / 2;
    for (int z = first; z <= last; z++) {
        const short16 away = as_short16(position) - (short16)(short)(z * UNIT);
        const short16 weight = max((short16)UNIT - max(away, -away), (short16)0);
        sum += as_ushort16(weight) * convert_ushort16(samples_at(source, z, x, y));
    }
    return convert_uchar16(sum >> (ushort)8);
}

/* 2^x for x in -64..0, to 2e-4 (exp2() takes the lanes one by one). */
inline float16 power_of_2(float16 x)
{
    const int16 whole = convert_int16(x) - 1;
    const float16 f = x - convert_float16(whole);
    const float16 mantissa = 1.0f + f * (0.6959219f + f * (0.2249727f + f * 0.0791021f));
    return mantissa * as_float16((whole + 127) << 23);
}

/* Mean weighted by exp(-(z - u)^2 / (2 SOFT_PLANES^2)), z from floor(u) - 2 to floor(u) + 3. */
#define SOFT_PLANES 0.6f
#define LOG2_E 1.44269504f

inline uchar16 soft_samples(const Source *source, int x, int y, ushort16 position, int first, int last)
{
    const float16 u = convert_float16(position) * (1.0f / UNIT);
    const int16 floor_u = convert_int16(position) / UNIT;
    float16 sum = 0.0f, weights = 0.0f;
    for (int z = max(first - 2, 0); z <= min(last + 2, source->planes - 1); z++) {
        const float16 away = u - (float)z;
        const float16 weight = power_of_2(max(away * away * (-LOG2_E / (2.0f * SOFT_PLANES * SOFT_PLANES)), -60.0f));
        const int16 inside = z >= floor_u - 2 && z <= floor_u + 3;
        const float16 w = as_float16(as_int16(weight) & inside);
        sum += w * convert_float16(samples_at(source, z, x, y));
        weights += w;
    }
    return convert_uchar16(sum / weights + 0.5f);
}

/* One work-item a row of one component, as compose of aif.cl. */
__kernel void compose_rows(__global const uchar *stack, __global const ulong2 *table, int first_row,
                           __global const ushort *depth, __global const ushort *positions, float scale,
                           __global uchar *picture, ulong2 picture_rows, int component_width, int channels,
                           int subsampling, int2 depth_size, int depth_stride, int planes,
                           __global const Noise *noise)
{
    const int soft = noise && noise->t > 0.5f;
    const int y = (int)get_group_id(0), pixels = component_width / channels;
    const Source source = {stack, table + first_row, planes};
    __global const ushort *above = depth + (ulong)(y * subsampling) * depth_stride;
    __global const ushort *below = depth + (ulong)min(y * subsampling + 1, depth_size.y - 1) * depth_stride;
    __global uchar *out = picture + picture_rows.x + picture_rows.y * (ulong)y;

    FOR_EACH_16(x, pixels)
    {
        const ushort16 pixel_positions =
            subsampling == 1 ? positions_of(*(__global const lanes16 *)(above + x), positions, scale)
                             : chroma_positions(above, below, x, depth_size.x, positions, scale);
        const short16 none = pixel_positions == (ushort16)NO_POSITION;
        const int first = lowest(pixel_positions) / UNIT;
        const int last = min(highest(pixel_positions & ~as_ushort16(none)) / UNIT + 1, planes - 1);
        const int some_unknown = any(none);
        for (int part = 0; part < channels; part++) {
            const ushort16 position = positions_of_samples(pixel_positions, channels, part);
            const int sample = x * channels + part * 16;
            uchar16 value = soft ? soft_samples(&source, sample, y, position, first, last)
                                 : linear_samples(&source, sample, y, position, first, last);
            if (some_unknown)
                value = convert_char16(position == (ushort16)NO_POSITION) ? mean_samples(&source, sample, y) : value;
            *(__global lanes8 *)(out + sample) = value;
        }
    }
}
