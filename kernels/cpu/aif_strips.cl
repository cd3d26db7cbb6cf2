/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The all-in-focus picture of aif.cl for CPUs, at the depth of soften_depth.cl, samples of 8 bits: one work-item a
 * strip of STRIP rows, whose positions stay in the core's cache. What differs: positions are counted in 1/256 plane,
 * which moves a sample by at most 1/512 of what it changes from one plane to the next.
 */
#include "../noise_type.cl"
#include "lanes32.cl"

#define UNIT 256 /* positions a plane */
#define NO_POSITION 65535
#define STRIP 8 /* rows, an even number */
#define MOST_COLUMNS 8192
#define STRIDE (MOST_COLUMNS + 64)
#define NONE 65535 /* no depth around, less 1 */

/* One component of the picture. */
typedef struct {
    ulong offset, stride; /* of its rows in the picture, bytes */
    int first_row;        /* in the stack's table */
    int width, height;    /* samples */
    int channels, subsampling;
} Component;

/* A depth map, and what its pixels mean: with `scale` above 0 a pixel d means position scale (d - 1), otherwise it is
 * looked up. */
typedef struct {
    __global const ushort *pixels;
    int width, height, stride;
    __global const ushort *positions;
    float scale;
} Depth;

inline __global const ushort *depth_row(const Depth *depth, int y)
{
    return depth->pixels + (ulong)clamp(y, 0, depth->height - 1) * depth->stride;
}

inline ushort position_of(const Depth *depth, ushort pixel)
{
    if (depth->scale > 0.0f)
        return pixel ? (ushort)((pixel - 1) * depth->scale + 0.5f) : (ushort)NO_POSITION;
    return depth->positions[pixel];
}

/* Positions of 16 depth pixels less 1, given as whole numbers or means. */
inline ushort16 positions_of(const Depth *depth, float16 pixels)
{
    if (depth->scale > 0.0f)
        return convert_ushort16(pixels * depth->scale + 0.5f);
    ushort lanes[16];
    *(lanes16 *)lanes = convert_ushort16(pixels + 0.5f) + (ushort)1;
    for (int i = 0; i < 16; i++)
        lanes[i] = depth->positions[lanes[i]];
    return *(lanes16 *)lanes;
}

/* The least depth around each pixel of a row, less 1. Returns whether any pixel of the row has no depth. */
inline int nearest_row(const Depth *depth, int y, ushort *nearest)
{
    __global const ushort *above = depth_row(depth, y - 1), *here = depth_row(depth, y);
    __global const ushort *below = depth_row(depth, y + 1);
    const int width = depth->width;
    ushort32 unknown = 0;
    nearest[0] = here[0] - 1;
    nearest[width - 1] = here[width - 1] - 1;
    for (int block = 1; block < width - 1; block += 32) {
        const int x = min(block, width - 33);
        ushort32 least = NONE;
        for (int i = -1; i <= 1; i++) {
            const ushort32 a = *(__global const lanes32 *)(above + x + i) - (ushort)1;
            const ushort32 b = *(__global const lanes32 *)(here + x + i) - (ushort)1;
            const ushort32 c = *(__global const lanes32 *)(below + x + i) - (ushort)1;
            least = min32(least, min32(min32(a, b), c));
            unknown |= as_ushort32(b == (ushort)NONE);
        }
        *(lanes32 *)(nearest + x) = least;
    }
    const uint16 either = as_uint16(unknown);
    return any(either != 0);
}

/* Sum of three neighbours in a row. */
inline float16 sum_3(const ushort *row)
{
    return convert_float16(convert_int16(*(const lanes16 *)(row - 1)) + convert_int16(*(const lanes16 *)row) +
                           convert_int16(*(const lanes16 *)(row + 1)));
}

/* Softened positions of a strip, all of whose pixels have a depth; nearest: the rows from the one before on. */
inline void soften(const Depth *depth, const ushort *nearest, int rows, ushort *positions)
{
    for (int block = 1; block < depth->width - 1; block += 16) {
        const int x = min(block, depth->width - 17);
        float16 before = sum_3(nearest + x), here = sum_3(nearest + STRIDE + x);
        for (int y = 0; y < rows; y++) {
            const float16 after = sum_3(nearest + (y + 2) * STRIDE + x);
            *(lanes16 *)(positions + y * STRIDE + x) = positions_of(depth, (before + here + after) * (1.0f / 9.0f));
            before = here;
            here = after;
        }
    }
}

inline int16 or_own(ushort16 other, ushort16 own)
{
    return convert_int16(select(other, own, other == (ushort16)NONE));
}

/* The same where some pixels have no depth: they keep none and count for no other. */
inline void soften_known(const Depth *depth, const ushort *nearest, int top, int rows, ushort *positions)
{
    for (int y = 0; y < rows; y++)
        for (int block = 1; block < depth->width - 1; block += 16) {
            const int x = min(block, depth->width - 17);
            const ushort *around = nearest + (y + 1) * STRIDE + x;
            const ushort16 own = *(const lanes16 *)around;
            int16 sum = 0;
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++)
                    sum += or_own(*(const lanes16 *)(around + j * STRIDE + i), own);
            const ushort16 mean = positions_of(depth, convert_float16(sum) * (1.0f / 9.0f));
            const ushort16 pixel = *(__global const lanes16 *)(depth_row(depth, top + y) + x);
            *(lanes16 *)(positions + y * STRIDE + x) = select(mean, (ushort16)NO_POSITION, pixel == (ushort16)0);
        }
}

/* Positions of the strip's pixels, the last column and the last row twice. Returns whether some have none. */
inline int strip_positions(const Depth *depth, int top, int rows, ushort *positions)
{
    ushort nearest[(STRIP + 2) * STRIDE];
    int unknown = 0;
    for (int y = -1; y <= rows; y++)
        unknown |= nearest_row(depth, clamp(top + y, 0, depth->height - 1), nearest + (y + 1) * STRIDE);
    if (unknown)
        soften_known(depth, nearest, top, rows, positions);
    else
        soften(depth, nearest, rows, positions);

    const int last = depth->width - 1;
    for (int y = 0; y < rows; y++) {
        ushort *row = positions + y * STRIDE;
        row[0] = position_of(depth, depth_row(depth, top + y)[0]);
        row[last] = row[last + 1] = position_of(depth, depth_row(depth, top + y)[last]);
        unknown |= row[0] == NO_POSITION || row[last] == NO_POSITION;
    }
    if (rows % 2)
        for (int x = 0; x <= last + 1; x++)
            positions[rows * STRIDE + x] = positions[(rows - 1) * STRIDE + x];
    return unknown;
}

/* Sum of those that are known, and minus their number. */
inline void add_known(uint16 position, uint16 *sum, int16 *known)
{
    const int16 is_known = position != (uint16)NO_POSITION;
    *sum += position & as_uint16(is_known);
    *known += is_known;
}

/* Positions of 16 chroma samples: means of 2 x 2 pixels, over those that are known. */
inline ushort16 chroma_positions(const ushort *above, int unknown)
{
    const ushort32 a = *(const lanes32 *)above, b = *(const lanes32 *)(above + STRIDE);
    if (!unknown) {
        const uint16 sums = as_uint16(a + b); /* at most 2 (63 UNIT) a pixel's column: 16 bits */
        return convert_ushort16(((sums & 65535u) + (sums >> 16) + 2u) >> 2);
    }
    uint16 sum = 0;
    int16 known = 0;
    add_known(as_uint16(a) & 65535u, &sum, &known);
    add_known(as_uint16(a) >> 16, &sum, &known);
    add_known(as_uint16(b) & 65535u, &sum, &known);
    add_known(as_uint16(b) >> 16, &sum, &known);
    const float16 mean = convert_float16(sum) / convert_float16(max(-known, 1)) + 0.5f;
    return convert_ushort16(known == 0 ? (uint16)NO_POSITION : convert_uint16(mean));
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

/* Positions of a row's samples from those of its pixels. */
inline void sample_positions(const ushort *positions, const Component *component, int unknown, ushort *samples)
{
    const int pixels = component->width / component->channels;
    for (int x = 0; x < pixels; x += 16) {
        const ushort16 pixel = component->subsampling == 1 ? *(const lanes16 *)(positions + x)
                                                           : chroma_positions(positions + 2 * x, unknown);
        for (int part = 0; part < component->channels; part++)
            *(lanes16 *)(samples + x * component->channels + part * 16) =
                positions_of_samples(pixel, component->channels, part);
    }
}

typedef struct {
    __global const uchar *stack;
    __global const ulong2 *rows; /* of the component's planes */
    int planes;
} Source;

inline __global const uchar *samples_at(const Source *source, int z, int x, int y)
{
    return source->stack + source->rows[z].x + source->rows[z].y * (ulong)y + x;
}

inline uchar16 mean_samples(const Source *source, int x, int y)
{
    ushort16 sum = 0;
    for (int z = 0; z < source->planes; z++)
        sum += convert_ushort16(*(__global const lanes8 *)samples_at(source, z, x, y));
    return convert_uchar16(convert_float16(sum) / source->planes + 0.5f);
}

/* Planes that hold what is needed at some of 32 positions, or 16: from x to y. */
inline ushort lowest(ushort16 v)
{
    const ushort8 a = min(v.lo, v.hi);
    const ushort4 b = min(a.lo, a.hi);
    const ushort2 c = min(b.lo, b.hi);
    return min(c.lo, c.hi);
}

inline int2 planes_around(ushort16 least, ushort16 most, int planes)
{
    return (int2)(lowest(least) / UNIT, min((65535 - lowest(~most)) / UNIT + 1, planes - 1));
}

/* Between the two planes around each position. */
inline uchar32 linear_samples(const Source *source, int x, int y, ushort32 position)
{
    const ushort16 a = first_half(position), b = second_half(position);
    const int2 range = planes_around(min(a, b), max(a, b), source->planes);
    ushort32 sum = UNIT / 2;
    for (int z = range.x; z <= range.y; z++) {
        const short32 away = as_short32(position) - (short)(z * UNIT);
        const short32 weight = higher((short)UNIT - higher(away, -away), (short32)0);
        sum += as_ushort32(weight) * widen(*(__global const bytes32 *)samples_at(source, z, x, y));
        PREFETCH(samples_at(source, z, x, y + 1));
    }
    return __builtin_convertvector(sum >> (ushort)8, uchar32);
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
        sum += w * convert_float16(*(__global const lanes8 *)samples_at(source, z, x, y));
        weights += w;
    }
    return convert_uchar16(sum / weights + 0.5f);
}

/* The softened mean, or without noise the linear one, where some positions may be unknown. */
inline uchar16 any_samples(const Source *source, int x, int y, ushort16 position, int soft)
{
    const short16 none = position == (ushort16)NO_POSITION;
    const int2 range = planes_around(position, position & ~as_ushort16(none), source->planes);
    uchar16 value;
    if (soft) {
        value = soft_samples(source, x, y, position, range.x, range.y);
    } else {
        ushort16 sum = UNIT / 2;
        for (int z = range.x; z <= range.y; z++) {
            const short16 away = as_short16(position) - (short16)(short)(z * UNIT);
            const short16 weight = max((short16)UNIT - max(away, -away), (short16)0);
            sum += as_ushort16(weight) * convert_ushort16(*(__global const lanes8 *)samples_at(source, z, x, y));
        }
        value = convert_uchar16(sum >> (ushort)8);
    }
    return any(none) ? select(value, mean_samples(source, x, y), convert_char16(none)) : value;
}

/* One work-item a strip of all components. */
__kernel void compose_strip(__global const uchar *stack, __global const ulong2 *table,
                            __global const ushort *depth_pixels, int2 depth_size, int depth_stride,
                            __global const ushort *position_table, float scale, __global uchar *picture,
                            __global const Component *components, int component_count, int planes,
                            __global const Noise *noise)
{
    ushort positions[(STRIP + 1) * STRIDE];
    ushort samples[4 * STRIDE];
    const Depth depth = {depth_pixels, depth_size.x, depth_size.y, depth_stride, position_table, scale};
    const int top = (int)get_group_id(0) * STRIP, rows = min(STRIP, depth.height - top);
    const int soft = noise && noise->t > 0.5f;
    const int unknown = strip_positions(&depth, top, rows, positions);

    for (int c = 0; c < component_count; c++) {
        const Component component = components[c];
        const Source source = {stack, table + component.first_row, planes};
        for (int row = 0; row < rows; row += component.subsampling) {
            const int y = (top + row) / component.subsampling;
            __global uchar *out = picture + component.offset + component.stride * (ulong)y;
            sample_positions(positions + row * STRIDE, &component, unknown, samples);
            if (soft || unknown)
                FOR_EACH_16(x, component.width)
                    *(__global lanes8 *)(out + x) =
                        any_samples(&source, x, y, *(const lanes16 *)(samples + x), soft);
            else
                FOR_EACH_32(x, component.width)
                    *(__global bytes32 *)(out + x) = linear_samples(&source, x, y, *(const lanes32 *)(samples + x));
        }
    }
}
