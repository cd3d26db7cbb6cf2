/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The all-in-focus picture of aif.cl for CPUs, at the depth of soften_depth.cl, samples of 8 bits: one work-item a
 * strip of STRIP rows of at most MOST_COLUMNS pixels, whose positions stay in the core's cache. What differs: positions are counted in 1/256 plane
 * and, means being taken in 16 bits, at most 0.5 + N / 36 of these off; as much of 1/256 of what a sample changes from
 * one plane to the next.
 */
#include "../noise_type.cl"
#include "lanes32.cl"

#define UNIT 256 /* positions a plane */
#define NO_POSITION 65535
#define STRIP 16 /* rows, an even number */
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

INLINE __global const ushort *depth_row(const Depth *depth, int y)
{
    return depth->pixels + (ulong)clamp(y, 0, depth->height - 1) * depth->stride;
}

INLINE ushort position_of(const Depth *depth, ushort pixel)
{
    if (depth->scale > 0.0f)
        return pixel ? (ushort)((pixel - 1) * depth->scale + 0.5f) : (ushort)NO_POSITION;
    return depth->positions[pixel];
}

/* Positions of 16 depth pixels less 1, given as whole numbers or means. */
INLINE ushort16 positions_of(const Depth *depth, float16 pixels)
{
    if (depth->scale > 0.0f)
        return convert_ushort16(pixels * depth->scale + 0.5f);
    ushort lanes[16];
    *(lanes16 *)lanes = convert_ushort16(pixels + 0.5f) + (ushort)1;
    for (int i = 0; i < 16; i++)
        lanes[i] = depth->positions[lanes[i]];
    return *(lanes16 *)lanes;
}

/* The least of three neighbours in a row, less 1; `most`: the greatest of the middle ones and of itself. */
INLINE ushort32 least_of_3(__global const ushort *row, ushort32 *most)
{
    const ushort32 left = *(__global const lanes32 *)(row - 1) - (ushort)1;
    const ushort32 here = *(__global const lanes32 *)row - (ushort)1;
    const ushort32 right = *(__global const lanes32 *)(row + 1) - (ushort)1;
    *most = max32(*most, here);
    return min32(min32(left, here), right);
}

INLINE void copy_row(const ushort *row, ushort *copy, int width)
{
    FOR_EACH_32(x, width)
        *(lanes32 *)(copy + x) = *(const lanes32 *)(row + x);
}

/* The least depth around each pixel of a strip's rows, less 1, and of the ones before and after it. Returns whether any
 * pixel around has no depth. */
INLINE int nearest_rows(const Depth *depth, int top, int rows, ushort *nearest)
{
    const int width = depth->width;
    __global const ushort *lines[STRIP + 4];
    for (int y = 0; y < rows + 4; y++)
        lines[y] = depth_row(depth, top - 2 + y);

    ushort32 most = 0;
    for (int block = 1; block < width - 1; block += 32) {
        const int x = min(block, width - 33);
        ushort32 above = least_of_3(lines[0] + x, &most), here = least_of_3(lines[1] + x, &most);
        for (int y = 0; y < rows + 2; y++) {
            const ushort32 below = least_of_3(lines[y + 2] + x, &most);
            PREFETCH(lines[y + 2] + x + 256);
            *(lanes32 *)(nearest + y * STRIDE + x) = min32(min32(above, here), below);
            above = here;
            here = below;
        }
    }
    int unknown = most_of(most) == NONE;
    for (int y = 0; y < rows + 2; y++) {
        ushort *row = nearest + y * STRIDE;
        row[0] = lines[y + 1][0] - 1;
        row[width - 1] = lines[y + 1][width - 1] - 1;
        unknown |= row[0] == NONE || row[width - 1] == NONE;
    }
    if (top == 0)
        copy_row(nearest + STRIDE, nearest, width);
    if (top + rows == depth->height)
        copy_row(nearest + rows * STRIDE, nearest + (rows + 1) * STRIDE, width);
    return unknown;
}

/* Sum of three neighbours in a row, in parts of 9. */
INLINE ushort32 third_of_mean(const ushort *row)
{
    const ushort32 ninth = (ushort)7282; /* of 65536 */
    return part_of(*(const lanes32 *)(row - 1), ninth) + part_of(*(const lanes32 *)row, ninth) +
           part_of(*(const lanes32 *)(row + 1), ninth);
}

/* Positions of 32 depth pixels less 1, all of which have a depth. */
INLINE ushort32 positions_of_32(const Depth *depth, ushort32 pixels)
{
    if (depth->scale > 0.0f) {
        const ushort32 scale = (ushort)(depth->scale * 65536.0f + 0.5f);
        return part_of(pixels, scale) + (pixels * scale >> (ushort)15); /* the product's lower half rounds */
    }
    ushort lanes[32];
    *(lanes32 *)lanes = pixels + (ushort)1;
    for (int i = 0; i < 32; i++)
        lanes[i] = depth->positions[lanes[i]];
    return *(lanes32 *)lanes;
}

/* Softened positions of a strip, all of whose pixels have a depth; nearest: the rows from the one before on. */
INLINE void soften(const Depth *depth, const ushort *nearest, int rows, ushort *positions)
{
    for (int block = 1; block < depth->width - 1; block += 32) {
        const int x = min(block, depth->width - 33);
        ushort32 before = third_of_mean(nearest + x), here = third_of_mean(nearest + STRIDE + x);
        for (int y = 0; y < rows; y++) {
            const ushort32 after = third_of_mean(nearest + (y + 2) * STRIDE + x);
            *(lanes32 *)(positions + y * STRIDE + x) = positions_of_32(depth, before + here + after + (ushort)4);
            before = here;
            here = after;
        }
    }
}

INLINE int16 or_own(ushort16 other, ushort16 own)
{
    return convert_int16(select(other, own, other == (ushort16)NONE));
}

/* The same where some pixels have no depth: they keep none and count for no other. */
INLINE void soften_known(const Depth *depth, const ushort *nearest, int top, int rows, ushort *positions)
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
INLINE int strip_positions(const Depth *depth, int top, int rows, ushort *positions)
{
    ushort nearest[(STRIP + 2) * STRIDE];
    int unknown = nearest_rows(depth, top, rows, nearest);
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
INLINE void add_known(uint16 position, uint16 *sum, int16 *known)
{
    const int16 is_known = position != (uint16)NO_POSITION;
    *sum += position & as_uint16(is_known);
    *known += is_known;
}

/* Positions of 16 chroma samples: means of 2 x 2 pixels, over those that are known. */
INLINE ushort16 chroma_positions(const ushort *above, int unknown)
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
    const float16 mean = convert_float16(sum) / convert_float16(max(-known, (int16)1)) + 0.5f;
    return convert_ushort16(known == 0 ? (uint16)NO_POSITION : convert_uint16(mean));
}

/* Positions of the part-th 16 samples of 16 pixels with interleaved channels. */
INLINE ushort16 positions_of_samples(ushort16 p, int channels, int part)
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
INLINE void sample_positions(const ushort *positions, const Component *component, int unknown, ushort *samples)
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
    ushort steepness; /* of aif.cl, in 1/UNIT, even */
} Source;

INLINE __global const uchar *samples_at(const Source *source, int z, int x, int y)
{
    return source->stack + source->rows[z].x + source->rows[z].y * (ulong)y + x;
}

INLINE uchar16 mean_samples(const Source *source, int x, int y)
{
    ushort16 sum = 0;
    for (int z = 0; z < source->planes; z++)
        sum += convert_ushort16(*(__global const lanes8 *)samples_at(source, z, x, y));
    return convert_uchar16(convert_float16(sum) / source->planes + 0.5f);
}

/* Planes that hold what is needed at positions from `least` to `most`: from x to y. */
INLINE int2 planes_between(ushort least, ushort most, int planes)
{
    return (int2)(least / UNIT, min(most / UNIT + 1, planes - 1));
}

/* Positions that give each plane the share of aif.cl when interpolated between. */
#define STEEPENED(lanes, highest, lowest)                                                                              \
    INLINE lanes __attribute__((overloadable)) steepened(lanes position, ushort steepness)                             \
    {                                                                                                                  \
        const lanes centre = (ushort)(steepness / 2), share = position & (ushort)(UNIT - 1);                           \
        const lanes grown = share + (share * steepness >> (ushort)8);                                                  \
        return position - share + lowest(highest(grown, centre) - centre, (lanes)(ushort)UNIT);                        \
    }
STEEPENED(ushort16, max, min)
STEEPENED(ushort32, max32, min32)

/* Between the two planes around each position: mostly the same two for all. */
INLINE uchar32 linear_samples(const Source *source, int x, int y, ushort32 unsteepened)
{
    const ushort32 position = steepened(unsteepened, source->steepness);
    const int first = min(position[0] / UNIT, source->planes - 2);
    const ushort32 share = position - (ushort)(first * UNIT);
    ushort32 sum = UNIT / 2;
    if (!any_of(share > (ushort)UNIT)) {
        const ushort32 before = widen(*(__global const bytes32 *)samples_at(source, first, x, y));
        const ushort32 after = widen(*(__global const bytes32 *)samples_at(source, first + 1, x, y));
        PREFETCH(samples_at(source, first, x, y + 1));
        PREFETCH(samples_at(source, first + 1, x, y + 1));
        sum += before * (ushort)UNIT + share * (after - before);
    } else {
        const int2 range =
            planes_between(least_of(position), most_of(position), source->planes);
        for (int z = range.x; z <= range.y; z++) {
            const short32 away = as_short32(position) - (short)(z * UNIT);
            const short32 weight = higher((short)UNIT - higher(away, -away), (short32)0);
            sum += as_ushort32(weight) * widen(*(__global const bytes32 *)samples_at(source, z, x, y));
            PREFETCH(samples_at(source, z, x, y + 1));
        }
    }
    return __builtin_convertvector(sum >> (ushort)8, uchar32);
}

/* 2^x for x in -64..0, to 2e-4 (exp2() takes the lanes one by one). */
INLINE float16 power_of_2(float16 x)
{
    const int16 whole = convert_int16(x) - 1;
    const float16 f = x - convert_float16(whole);
    const float16 mantissa = 1.0f + f * (0.6959219f + f * (0.2249727f + f * 0.0791021f));
    return mantissa * as_float16((whole + 127) << 23);
}

/* Mean weighted by exp(-(z - u)^2 / (2 SOFT_PLANES^2)), z from floor(u) - 2 to floor(u) + 3. */
#define SOFT_PLANES 0.6f
#define LOG2_E 1.44269504f

INLINE uchar16 soft_samples(const Source *source, int x, int y, ushort16 position, int first, int last)
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

INLINE void add_weighted(const Source *source, int z, int x, int y, float16 weight, float16 *sum, float16 *weights)
{
    if (z < 0 || z >= source->planes)
        return;
    *sum += weight * convert_float16(*(__global const lanes8 *)samples_at(source, z, x, y));
    *weights += weight;
}

/* The same where all positions lie f planes behind plane `floor_u`, f from 0 to 1. Weights are those over that plane's:
 *
 *     w(k) = 2^(-b (k^2 - 2 k f)) = w(1)^k c^((k^2 - k) / 2) behind it, likewise before it, with c = 2^(-2 b)
 */
#define SOFT_LOG2 (LOG2_E / (2.0f * SOFT_PLANES * SOFT_PLANES))
#define SOFT_ROOT 0.24935221f /* 2^-SOFT_LOG2 */
#define SOFT_STEP (SOFT_ROOT * SOFT_ROOT)

INLINE uchar16 soft_samples_between(const Source *source, int x, int y, ushort16 position, int floor_u)
{
    const float16 f = convert_float16(position & (ushort)(UNIT - 1)) * (1.0f / UNIT);
    const float16 before = power_of_2(f * (-2.0f * SOFT_LOG2)) * SOFT_ROOT;
    const float16 behind = power_of_2((f - 1.0f) * (2.0f * SOFT_LOG2)) * (1.0f / SOFT_ROOT);
    const float16 second = behind * behind * SOFT_STEP;
    float16 sum = 0.0f, weights = 0.0f;
    add_weighted(source, floor_u - 2, x, y, before * before * SOFT_STEP, &sum, &weights);
    add_weighted(source, floor_u - 1, x, y, before, &sum, &weights);
    add_weighted(source, floor_u, x, y, 1.0f, &sum, &weights);
    add_weighted(source, floor_u + 1, x, y, behind, &sum, &weights);
    add_weighted(source, floor_u + 2, x, y, second, &sum, &weights);
    add_weighted(source, floor_u + 3, x, y, second * behind * (SOFT_STEP * SOFT_STEP), &sum, &weights);
    return convert_uchar16(sum / weights + 0.5f);
}

/* The softened mean, or without noise the linear one, where some positions may be unknown. */
INLINE uchar16 any_samples(const Source *source, int x, int y, ushort16 position, int soft)
{
    const short16 none = position == (ushort16)NO_POSITION;
    const ushort least = least_of(position), most = most_of(position & ~as_ushort16(none));
    const int2 range = planes_between(least, most, source->planes);
    uchar16 value;
    if (soft && least / UNIT == most / UNIT) {
        value = soft_samples_between(source, x, y, position, range.x);
    } else if (soft) {
        value = soft_samples(source, x, y, position, range.x, range.y);
    } else {
        const ushort16 steep = steepened(position, source->steepness);
        ushort16 sum = UNIT / 2;
        for (int z = range.x; z <= range.y; z++) {
            const short16 away = as_short16(steep) - (short16)(short)(z * UNIT);
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
                            __global const Noise *noise, int is_soft)
{
    ushort positions[(STRIP + 1) * STRIDE];
    ushort samples[4 * STRIDE];
    const Depth depth = {depth_pixels, depth_size.x, depth_size.y, depth_stride, position_table, scale};
    const int top = (int)get_group_id(0) * STRIP, rows = min(STRIP, depth.height - top);
    const int soft = is_soft && noise->t > 0.5f;
    const ushort steepness = 2 * (ushort)(0.25f * UNIT * clamp(1.0f - 2.0f * noise->t, 0.0f, 1.0f));
    const int unknown = strip_positions(&depth, top, rows, positions);

    for (int c = 0; c < component_count; c++) {
        const Component component = components[c];
        const Source source = {stack, table + component.first_row, planes, steepness};
        for (int row = 0; row < rows; row += component.subsampling) {
            const int y = (top + row) / component.subsampling;
            __global uchar *out = picture + component.offset + component.stride * (ulong)y;
            const ushort *position = positions + row * STRIDE;
            if (component.channels > 1 || component.subsampling > 1) {
                sample_positions(position, &component, unknown, samples);
                position = samples;
            }
            if (soft || unknown)
                FOR_EACH_16(x, component.width)
                    *(__global lanes8 *)(out + x) =
                        any_samples(&source, x, y, *(const lanes16 *)(position + x), soft);
            else
                FOR_EACH_32(x, component.width)
                    *(__global bytes32 *)(out + x) = linear_samples(&source, x, y, *(const lanes32 *)(position + x));
        }
    }
}
