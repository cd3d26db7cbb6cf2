/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The fine focus volume F0 at 1/SCALE, from the stack at full resolution:
 *
 *     F0_z = area-downsample_SCALE(box_RADIUS(SML(g * I_z))),  SML(I) = |[-1 2 -1] * I|_x + |.|_y,  RADIUS = SCALE / 2
 *
 * g is the pre-blur that the noise asks for. Box and downsampling together weigh 2 SCALE samples by 1 2 .. SCALE SCALE .. 2 1
 * in each direction: of the groups of SCALE samples that begin RADIUS before a cell's, cell i adds up group i with rising
 * weights and group i + 1 with falling ones.
 *
 * I is SAMPLE: uchar luma, or ushort thirds of a DN (the sum of R, G, B). 16 columns are worked on at a time, in lanes
 * of 16 bits. One work-item takes `strip` low rows of one plane: work-items (1, strips, planes); it keeps rows in
 * `scratch`, whose rows have room for `width` samples and PAD at both ends.
 */
#include "low_picture.cl"

#define RADIUS (SCALE / 2)
#define WEIGHTS (SCALE * (SCALE + 1))
#define PAD 16

/* Rows of scratch: samples turned into thirds, samples blurred (rings), one blurred over columns only, the last group's
 * sums over columns (two, in turn), the low row's sums over columns. */
#define RING (SCALE <= 4 ? 8 : 16)
#define BLURRED_RING RING
#define HALF_BLURRED (2 * RING)
#define RISING (2 * RING + 1)
#define COLUMNS (2 * RING + 3)
#define SCRATCH_ROWS (2 * RING + 4)

typedef uchar16 uchar16_anywhere __attribute__((aligned(1)));

#define READ_BYTES(pointer) convert_short16(*(__global const uchar16_anywhere *)(pointer))

/* So that WEIGHTS of them fit 16 bits. */
#define LARGEST_SML (65535 / WEIGHTS)

INLINE short16 magnitude(short16 v)
{
    return max(v, -v);
}

/* Runs over a row's samples from `first` to `last` in 16s, of which the last may overlap those before. */
#define FOR_SAMPLES(x, first, last)                                                                                    \
    for (int x = (first); x < (last); x = x + 16 < (last) ? min(x + 16, (last) - 16) : (last))

/* Sums SML, LARGEST at most, over a group of rows; ROW(k), k = -1 .. SCALE, points at them. Writes the low row that ends with this group to
 * `columns` and keeps what the next one begins with in `rising`. */
#define ADD_GROUP(ROW, READ, SHIFT, LARGEST)                                                                                    \
    FOR_SAMPLES(x, 1, width - 1)                                                                                       \
    {                                                                                                                  \
        short16 above = READ(ROW(-1) + x), here = READ(ROW(0) + x);                                                    \
        ushort16 sum = 0, rising_sum = 0;                                                                              \
        UNROLL                                                                                                         \
        for (int k = 0; k < SCALE; k++) {                                                                              \
            const short16 below = READ(ROW(k + 1) + x);                                                                \
            const short16 twice = here + here;                                                                         \
            const short16 dx = twice - READ(ROW(k) + x - 1) - READ(ROW(k) + x + 1), dy = twice - above - below;        \
            const ushort16 sml = as_ushort16(magnitude(dx) + magnitude(dy)) >> (ushort)SHIFT;                          \
            const ushort16 bounded = (LARGEST) <= LARGEST_SML ? sml : min(sml, (ushort16)LARGEST_SML);                  \
            sum += bounded;                                                                                            \
            rising_sum += bounded * (ushort)(k + 1);                                                                   \
            above = here;                                                                                              \
            here = below;                                                                                              \
        }                                                                                                              \
        USHORTS(columns + x) = READ_USHORTS(rising + x) + (sum * (ushort)(SCALE + 1) - rising_sum);                    \
        USHORTS(next_rising + x) = rising_sum;                                                                         \
    }

/* Repeats the first and last SML of a low row outward, where there is none. */
INLINE void extend_columns(__global ushort *columns, int width)
{
    const ushort16 first = columns[1], last = columns[width - 2];
    USHORTS(columns - 15) = first;
    USHORTS(columns + width - 1) = last;
}

/* The i-th samples of 8 groups of SCALE, which begin at `groups`. */
INLINE void part_groups(__global const ushort *groups, uint8 *parts)
{
#if SCALE == 2
    const ushort16 all = READ_USHORTS(groups);
    parts[0] = convert_uint8(all.even);
    parts[1] = convert_uint8(all.odd);
#else
    for (int half_of_them = 0; half_of_them < SCALE / 4; half_of_them++) {
#if SCALE == 4
        const ushort16 left = READ_USHORTS(groups), right = READ_USHORTS(groups + 16);
#else
        const ushort16 v0 = READ_USHORTS(groups + 4 * half_of_them), v1 = READ_USHORTS(groups + 4 * half_of_them + 16),
                       v2 = READ_USHORTS(groups + 4 * half_of_them + 32),
                       v3 = READ_USHORTS(groups + 4 * half_of_them + 48);
        const ushort16 left = (ushort16)(v0.s0123, v0.s89ab, v1.s0123, v1.s89ab);
        const ushort16 right = (ushort16)(v2.s0123, v2.s89ab, v3.s0123, v3.s89ab);
#endif
        const ushort16 even = (ushort16)(left.even, right.even), odd = (ushort16)(left.odd, right.odd);
        parts[4 * half_of_them] = convert_uint8(even.even);
        parts[4 * half_of_them + 1] = convert_uint8(odd.even);
        parts[4 * half_of_them + 2] = convert_uint8(even.odd);
        parts[4 * half_of_them + 3] = convert_uint8(odd.odd);
    }
#endif
}

/* A low row of F0 from its sums over columns, times `unit`. */
INLINE void sum_groups(__global const ushort *columns, __global short *focus, int low_width, float unit)
{
    for (int x = 0; x < low_width; x += 8) {
        const int i = min(x, max(low_width - 8, 0));
        uint8 parts[SCALE], rising = 0, falling = 0;
        part_groups(columns + i * SCALE - RADIUS, parts);
        UNROLL
        for (int k = 0; k < SCALE; k++)
            rising += parts[k] * (uint)(k + 1);
        part_groups(columns + (i + 1) * SCALE - RADIUS, parts);
        UNROLL
        for (int k = 0; k < SCALE; k++)
            falling += parts[k] * (uint)(SCALE - k);
        const float8 sum = convert_float8(convert_int8(rising + falling));
        HALF_SHORTS(focus + i) = to_shorts(unit * sum);
    }
}

INLINE __global ushort *scratch_row(__global ushort *scratch, int index, int width)
{
    return scratch + (size_t)index * (width + 2 * PAD) + PAD;
}

INLINE void clear(__global ushort *row, int width)
{
    FOR_SAMPLES(x, 0, width)
        USHORTS(row + x) = 0;
}

#define IS_WANTED(z) (wanted >> (z) & 1 || noise->is_new)

/* In silence, from luma of 8 bits where it lies. Planes whose bit of `wanted` is not set stay as they are, unless the
 * noise has changed. */
__kernel void focus_volume(__global const uchar *stack, __global const ulong2 *rows, __global const Noise *noise,
                           ulong wanted, __global ushort *scratch, __global short *focus, int width, int height,
                           int low_width, int low_height, int stride, int strip)
{
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * strip, last = min(first + strip, low_height);
    if (noise->taps[0] != 64 || !IS_WANTED(z))
        return;
    scratch += (z * get_global_size(1) + get_global_id(1)) * SCRATCH_ROWS * (size_t)(width + 2 * PAD);
    __global ushort *columns = scratch_row(scratch, COLUMNS, width);
    const float unit = (float)FOCUS_ONE / (WEIGHTS * WEIGHTS);
    clear(scratch_row(scratch, RISING + first % 2, width), width);
    for (int group = first; group <= last; group++) {
        __global const ushort *rising = scratch_row(scratch, RISING + group % 2, width);
        __global ushort *next_rising = scratch_row(scratch, RISING + 1 - group % 2, width);
        __global const uchar *lines[SCALE + 2];
        for (int k = -1; k <= SCALE; k++)
            lines[k + 1] = stack + rows[z].x + rows[z].y * (ulong)mirror(group * SCALE - RADIUS + k, height);
#define LINE(k) lines[(k) + 1]
        ADD_GROUP(LINE, READ_BYTES, 0, 4 * 255)
        if (group == first)
            continue; /* the groups before are another strip's */
        extend_columns(columns, width);
        sum_groups(columns, focus + ((size_t)z * low_height + group - 1) * stride + SIDE, low_width, unit);
    }
}

#ifdef THIRDS
/* R + G + B of interleaved colours, or luma or colours of 16 bits as 765ths. */
INLINE void make_thirds(__global const uchar *row, __global ushort *thirds, int width, int4 channels)
{
#if LUMA_BYTES == 2 && !defined(INTERLEAVED)
    for (int x = 0; x < width; x++)
        thirds[x] = (ushort)((sample_of(row, x) * 765u + 32768u) >> 16);
#elif LUMA_BYTES == 2
    for (int x = 0; x < width; x++) {
        const ulong pixel = (ulong)x * channels.s0;
        const uint sum = sample_of(row, pixel) + sample_of(row, pixel + 1) + sample_of(row, pixel + 2);
        thirds[x] = (ushort)((sum * 255u + 32768u) >> 16);
    }
#else
    for (int x = 0; x < width; x++) {
        __global const uchar *pixel = row + x * channels.s0;
        thirds[x] = (ushort)(pixel[0] + pixel[1] + pixel[2]);
    }
#endif
}
#define SAMPLE ushort
#define READ_SAMPLES(pointer) as_ushort16(READ_SHORTS(pointer))
#define COLUMN_SHIFT 6 /* leaves thirds; rows then leave a quarter of that */
#define BLURRED_A_DN 3
#else
#define SAMPLE uchar
#define READ_SAMPLES(pointer) convert_ushort16(*(__global const uchar16_anywhere *)(pointer))
#define COLUMN_SHIFT 4 /* leaves 1/4 DN; rows then a quarter of that */
#define BLURRED_A_DN 4
#endif

/* g over columns: 16 samples of a row from those above and below. Taps in 1/64. */
#define BLUR_16(READ, line, x, shift)                                                                            \
    ((READ(line(0) + (x)) * centre + (READ(line(-1) + (x)) + READ(line(1) + (x))) * near +                             \
      (READ(line(-2) + (x)) + READ(line(2) + (x))) * far + (READ(line(-3) + (x)) + READ(line(3) + (x))) * farthest) >> \
     (ushort)(shift))

/* The same in noise, or from other formats. */
__kernel void focus_volume_prepared(__global const uchar *stack, __global const ulong2 *rows, int4 channels,
                                    __global const Noise *noise, ulong wanted, __global ushort *scratch,
                                    __global short *focus, int width, int height, int low_width, int low_height,
                                    int stride, int strip)
{
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * strip, last = min(first + strip, low_height);
    const ushort centre = (ushort)noise->taps[0], near = (ushort)noise->taps[1], far = (ushort)noise->taps[2],
                 farthest = (ushort)noise->taps[3];
#ifndef THIRDS
    if (centre == 64)
        return;
#endif
    if (!IS_WANTED(z))
        return;
    scratch += (z * get_global_size(1) + get_global_id(1)) * SCRATCH_ROWS * (size_t)(width + 2 * PAD);
    __global ushort *columns = scratch_row(scratch, COLUMNS, width);
    __global ushort *half_blurred = scratch_row(scratch, HALF_BLURRED, width);
    const int top = first * SCALE - RADIUS - 1;
    const float unit = (float)FOCUS_ONE / (WEIGHTS * WEIGHTS * BLURRED_A_DN);
    int thirds_ready = top - 3, blurred_ready = top;

    clear(scratch_row(scratch, RISING + first % 2, width), width);
    for (int group = first; group <= last; group++) {
        const int y = group * SCALE - RADIUS;
        for (; blurred_ready <= y + SCALE; blurred_ready++) {
            __global ushort *blurred = scratch_row(scratch, BLURRED_RING + (blurred_ready + 64) % RING, width);
            __global const SAMPLE *lines[7];
#ifdef THIRDS
            for (; thirds_ready <= blurred_ready + 3; thirds_ready++)
                make_thirds(stack + rows[z].x + rows[z].y * (ulong)mirror(thirds_ready, height),
                            scratch_row(scratch, (thirds_ready + 64) % RING, width), width, channels);
            for (int i = -3; i <= 3; i++)
                lines[i + 3] = scratch_row(scratch, (blurred_ready + i + 64) % RING, width);
#else
            for (int i = -3; i <= 3; i++)
                lines[i + 3] = stack + rows[z].x + rows[z].y * (ulong)mirror(blurred_ready + i, height);
#endif
#define SAMPLES_OF(i) lines[(i) + 3]
#define HALF_BLURRED_AT(i) (half_blurred + (i))
            FOR_SAMPLES(x, 0, width)
                USHORTS(half_blurred + x) = BLUR_16(READ_SAMPLES, SAMPLES_OF, x, COLUMN_SHIFT);
            for (int i = 1; i <= 3; i++) {
                half_blurred[-i] = half_blurred[i];
                half_blurred[width - 1 + i] = half_blurred[width - 1 - i];
            }
            FOR_SAMPLES(x, 0, width)
                USHORTS(blurred + x) = BLUR_16(READ_USHORTS, HALF_BLURRED_AT, x, 4);
        }
        __global const ushort *rising = scratch_row(scratch, RISING + group % 2, width);
        __global ushort *next_rising = scratch_row(scratch, RISING + 1 - group % 2, width);
        __global const ushort *ready[SCALE + 2];
        for (int k = -1; k <= SCALE; k++)
            ready[k + 1] = scratch_row(scratch, BLURRED_RING + (y + k + 64) % RING, width);
#define READY(k) ready[(k) + 1]
        ADD_GROUP(READY, READ_SHORTS, 2, 4 * 255 * BLURRED_A_DN)
        if (group == first)
            continue;
        extend_columns(columns, width);
        sum_groups(columns, focus + ((size_t)z * low_height + group - 1) * stride + SIDE, low_width, unit);
    }
}
