/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The fine focus volume F0 at 1/SCALE, from the stack at full resolution:
 *
 *     F0_z = area-downsample_SCALE(box_RADIUS(SML(g * I_z))),  SML(I) = |[-1 2 -1] * I|_x + |.|_y,  RADIUS = SCALE / 2
 *
 * g is the pre-blur that the noise asks for. Box and downsampling together are one separable filter of REACH samples
 * with the weights of WEIGHT(), taken over columns first (focus_columns, at full width) and then over rows.
 *
 * I is SAMPLE: uchar luma, or ushort thirds of a DN (the sum of R, G, B). 16 columns are worked on at a time, in lanes
 * of 16 bits. One work-item takes a strip of STRIP low rows of one plane: work-items (1, strips, planes).
 */
#include "low_picture.cl"

#define RADIUS (SCALE / 2)
#define REACH (SCALE + 2 * RADIUS)
#define WEIGHT(k) min(min((k) + 1, REACH - (k)), SCALE)
#define WEIGHTS (SCALE * (2 * RADIUS + 1))

typedef short16 short16_anywhere __attribute__((aligned(2)));
typedef ushort16 ushort16_anywhere __attribute__((aligned(2)));
typedef uchar16 uchar16_anywhere __attribute__((aligned(1)));

#define READ_SAMPLES(pointer) convert_short16(*(__global const SAMPLES_ANYWHERE *)(pointer))
#define READ_SHORTS(pointer) (*(__global const short16_anywhere *)(pointer))

inline __global const SAMPLE *row_of(__global const uchar *stack, ulong2 rows, int y)
{
    return (__global const SAMPLE *)(stack + rows.x + rows.y * (ulong)y);
}

inline short16 magnitude(short16 v)
{
    return max(v, -v);
}

/* R + G + B of interleaved colours, or luma of 16 bits as 765ths. Work-items (1, height, planes). */
__kernel void thirds(__global const uchar *stack, __global const ulong2 *rows, __global ushort *sums, int width,
                     int4 channels)
{
    const int y = (int)get_global_id(1), z = (int)get_global_id(2);
    __global const uchar *row = stack + rows[z].x + rows[z].y * (ulong)y;
    __global ushort *out = sums + ((size_t)z * get_global_size(1) + y) * width;
#ifdef GRAY16
    for (int x = 0; x < width; x++)
        out[x] = (ushort)(((row[2 * x] | (uint)row[2 * x + 1] << 8) * 765u + 32768u) >> 16);
#else
    for (int x = 0; x < width; x++) {
        __global const uchar *pixel = row + x * channels.s0;
        out[x] = (ushort)(pixel[0] + pixel[1] + pixel[2]);
    }
#endif
}

/* Both blurs are in fixed point: taps in 1/64, columns leave COLUMN_SHIFT bits, rows 4 bits. A blurred sample is 16 DN
 * (uchar) or 12 DN (thirds). Work-items (1, height, planes). */
__kernel void blur_columns(__global const uchar *stack, __global const ulong2 *rows, __global const Noise *noise,
                           __global ushort *blurred, int width)
{
    const int y = (int)get_global_id(1), z = (int)get_global_id(2), height = (int)get_global_size(1);
    const ushort centre = (ushort)noise->taps[0];
    if (centre == 64)
        return;
    __global const SAMPLE *line[7];
    for (int i = -3; i <= 3; i++)
        line[i + 3] = row_of(stack, rows[z], mirror(y + i, height));
    __global ushort *out = blurred + ((size_t)z * height + y) * width;
    const ushort near = (ushort)noise->taps[1], far = (ushort)noise->taps[2], farthest = (ushort)noise->taps[3];
    for (int block = 0; block < width; block += 16) {
        const int x = min(block, width - 16);
        const ushort16 sum =
            as_ushort16(READ_SAMPLES(line[3] + x)) * centre +
            as_ushort16(READ_SAMPLES(line[2] + x) + READ_SAMPLES(line[4] + x)) * near +
            as_ushort16(READ_SAMPLES(line[1] + x) + READ_SAMPLES(line[5] + x)) * far +
            as_ushort16(READ_SAMPLES(line[0] + x) + READ_SAMPLES(line[6] + x)) * farthest;
        *(__global ushort16_anywhere *)(out + x) = sum >> (ushort)COLUMN_SHIFT;
    }
}

/* Columns 0 .. 2 and the last three stay as they are. */
__kernel void blur_rows(__global const ushort *source, __global const Noise *noise, __global ushort *blurred,
                        int width)
{
    const ushort centre = (ushort)noise->taps[0];
    if (centre == 64)
        return;
    const size_t row = (get_global_id(2) * get_global_size(1) + get_global_id(1)) * (size_t)width;
    const ushort near = (ushort)noise->taps[1], far = (ushort)noise->taps[2], farthest = (ushort)noise->taps[3];
    for (int i = 0; i < 3; i++) {
        blurred[row + i] = source[row + i] << 2;
        blurred[row + width - 1 - i] = source[row + width - 1 - i] << 2;
    }
    for (int block = 3; block < width - 3; block += 16) {
        const int x = min(block, width - 19);
        __global const ushort *in = source + row + x;
        const ushort16 sum =
            as_ushort16(READ_SHORTS(in)) * centre +
            as_ushort16(READ_SHORTS(in - 1) + READ_SHORTS(in + 1)) * near +
            as_ushort16(READ_SHORTS(in - 2) + READ_SHORTS(in + 2)) * far +
            as_ushort16(READ_SHORTS(in - 3) + READ_SHORTS(in + 3)) * farthest;
        *(__global ushort16_anywhere *)(blurred + row + x) = sum >> (ushort)4;
    }
}

/* Adds SML to the sums of the low row that ends here and of the one that begins. LOAD reads 16 samples. */
#define FOCUS_COLUMNS(SHIFT, LOAD, POINTER_TO)                                                                         \
    for (int block = 1; block < width - 1; block += 16) {                                                              \
        const int x = min(block, width - 17);                                                                          \
        int y = first * SCALE - RADIUS;                                                                                \
        short16 above = LOAD(POINTER_TO(mirror(y - 1, height)) + x);                                                   \
        short16 here = LOAD(POINTER_TO(mirror(y, height)) + x);                                                        \
        ushort16 sum = 0, next_sum = 0;                                                                                \
        for (int k = 0; k < 2 * RADIUS; k++, y++) {                                                                    \
            SML(SHIFT, LOAD, POINTER_TO)                                                                               \
            sum += sml * (ushort)WEIGHT(k);                                                                            \
        }                                                                                                              \
        for (int i = first; i < last; i++) {                                                                           \
            next_sum = 0;                                                                                              \
            for (int k = 0; k < SCALE; k++, y++) {                                                                     \
                SML(SHIFT, LOAD, POINTER_TO)                                                                           \
                sum += sml * (ushort)WEIGHT(2 * RADIUS + k);                                                           \
                next_sum += sml * (ushort)WEIGHT(k + 2 * RADIUS - SCALE);                                              \
            }                                                                                                          \
            *(__global ushort16_anywhere *)(out + (size_t)i * width + x) = sum;                                        \
            sum = next_sum;                                                                                            \
        }                                                                                                              \
    }

#define SML(SHIFT, LOAD, POINTER_TO)                                                                                   \
    const int row = mirror(y, height);                                                                                 \
    const short16 below = LOAD(POINTER_TO(mirror(y + 1, height)) + x);                                                 \
    const short16 twice = here + here;                                                                                 \
    const short16 dx = twice - LOAD(POINTER_TO(row) + x - 1) - LOAD(POINTER_TO(row) + x + 1);                          \
    const short16 dy = twice - above - below;                                                                          \
    const ushort16 sml = min(as_ushort16(magnitude(dx) + magnitude(dy)) >> (ushort)SHIFT, (ushort16)LARGEST_SML);      \
    above = here;                                                                                                      \
    here = below;

/* So that WEIGHTS of them fit 16 bits. */
#define LARGEST_SML (65535 / WEIGHTS)

/* columns ushort[planes][low height][width]; the first and the last column are not written. */
__kernel void focus_columns(__global const uchar *stack, __global const ulong2 *rows, __global const Noise *noise,
                            __global ushort *columns, int width, int height, int low_height)
{
    if (noise->taps[0] != 64)
        return;
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * STRIP, last = min(first + STRIP, low_height);
    __global ushort *out = columns + (size_t)z * low_height * width;
#define STACK_ROW(y) row_of(stack, rows[z], y)
    FOCUS_COLUMNS(0, READ_SAMPLES, STACK_ROW)
}

/* The same from the blurred stack, in 4 DN (uchar) or thirds. */
__kernel void focus_columns_blurred(__global const ushort *blurred, __global const Noise *noise,
                                    __global ushort *columns, int width, int height, int low_height)
{
    if (noise->taps[0] == 64)
        return;
    const int z = (int)get_global_id(2), first = (int)get_global_id(1) * STRIP, last = min(first + STRIP, low_height);
    __global ushort *out = columns + (size_t)z * low_height * width;
    __global const ushort *plane = blurred + (size_t)z * height * width;
#define BLURRED_ROW(y) (plane + (size_t)(y) * width)
    FOCUS_COLUMNS(2, READ_SHORTS, BLURRED_ROW)
}

/* F0 in DN from the column sums. Work-items (1, low height, planes). */
__kernel void focus_rows(__global const ushort *columns, __global const Noise *noise, __global float *focus, int width,
                         int low_width, int stride)
{
    const size_t row = get_global_id(2) * get_global_size(1) + get_global_id(1);
    __global const ushort *in = columns + row * width;
    __global float *out = focus + row * stride + SIDE;
    const float unit = 1.0f / ((noise->taps[0] == 64 ? SAMPLES_A_DN : BLURRED_SAMPLES_A_DN) * WEIGHTS * WEIGHTS);
    for (int i = 0; i < low_width; i++) {
        uint sum = 0;
        if (i > 0 && i < low_width - 1)
            for (int k = 0; k < REACH; k++)
                sum += WEIGHT(k) * (uint)in[i * SCALE - RADIUS + k];
        else
            for (int k = 0; k < REACH; k++)
                sum += WEIGHT(k) * (uint)in[clamp(i * SCALE - RADIUS + k, 1, width - 2)];
        out[i] = unit * sum;
    }
}
