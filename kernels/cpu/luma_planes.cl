/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Luma of 8 bits for CPUs: luma.cl in 16 lanes, that of 16 bits rounded to 8 bits, which the stages in lanes need.
 * luma[planes][height][width]; one work-item a row of a plane.
 */
inline uchar16 bt601(uchar16 red, uchar16 green, uchar16 blue)
{
    const uint16 weighted = convert_uint16(red) * 19595u + convert_uint16(green) * 38470u + convert_uint16(blue) * 7471u;
    return convert_uchar16((weighted + 32768u) >> 16);
}

__kernel void luma_of_3_bytes(__global const uchar *stack, __global const ulong2 *rows, __global uchar *luma, int width,
                              int height, int blue_first)
{
    const int y = (int)get_group_id(0), z = (int)get_group_id(1);
    __global const uchar *row = stack + rows[z].x + rows[z].y * (ulong)y;
    __global uchar *out = luma + ((ulong)z * height + y) * width;
    FOR_EACH_16(x, width)
    {
        __global const lanes8 *pixels = (__global const lanes8 *)(row + 3 * x);
        const uchar16 a = pixels[0], b = pixels[1], c = pixels[2];
        const uchar16 first = (uchar16)(a.s0369, a.scf, b.s258b, b.se, c.s147a, c.sd);
        const uchar16 second = (uchar16)(a.s147a, a.sd, b.s0369, b.scf, c.s258b, c.se);
        const uchar16 third = (uchar16)(a.s258b, a.se, b.s147a, b.sd, c.s0369, c.scf);
        *(__global lanes8 *)(out + x) = blue_first ? bt601(third, second, first) : bt601(first, second, third);
    }
}

__kernel void luma_of_4_bytes(__global const uchar *stack, __global const ulong2 *rows, __global uchar *luma, int width,
                              int height, int blue_first)
{
    const int y = (int)get_group_id(0), z = (int)get_group_id(1);
    __global const uchar *row = stack + rows[z].x + rows[z].y * (ulong)y;
    __global uchar *out = luma + ((ulong)z * height + y) * width;
    FOR_EACH_16(x, width)
    {
        __global const lanes8 *pixels = (__global const lanes8 *)(row + 4 * x);
        const uchar16 a = pixels[0], b = pixels[1], c = pixels[2], d = pixels[3];
        const uchar16 first = (uchar16)(a.s048c, b.s048c, c.s048c, d.s048c);
        const uchar16 second = (uchar16)(a.s159d, b.s159d, c.s159d, d.s159d);
        const uchar16 third = (uchar16)(a.s26ae, b.s26ae, c.s26ae, d.s26ae);
        *(__global lanes8 *)(out + x) = blue_first ? bt601(third, second, first) : bt601(first, second, third);
    }
}

/* Of little-endian samples, 65535 = 255 DN. */
inline uchar16 to_dn(uint16 samples)
{
    return convert_uchar16((samples * 255u + 32767u) / 65535u);
}

__kernel void luma_of_16_bits(__global const uchar *stack, __global const ulong2 *rows, __global uchar *luma, int width,
                              int height, int unused)
{
    const int y = (int)get_group_id(0), z = (int)get_group_id(1);
    __global const uchar *row = stack + rows[z].x + rows[z].y * (ulong)y;
    __global uchar *out = luma + ((ulong)z * height + y) * width;
    FOR_EACH_16(x, width)
    {
        __global const lanes8 *bytes = (__global const lanes8 *)(row + 2 * x);
        const uchar16 a = bytes[0], b = bytes[1];
        const uint16 low = convert_uint16((uchar16)(a.even, b.even)), high = convert_uint16((uchar16)(a.odd, b.odd));
        *(__global lanes8 *)(out + x) = to_dn(low | high << 8);
    }
}

__kernel void luma_of_4_shorts(__global const uchar *stack, __global const ulong2 *rows, __global uchar *luma, int width,
                               int height, int unused)
{
    const int y = (int)get_group_id(0), z = (int)get_group_id(1);
    __global const uchar *row = stack + rows[z].x + rows[z].y * (ulong)y;
    __global uchar *out = luma + ((ulong)z * height + y) * width;
    FOR_EACH_16(x, width)
    {
        __global const lanes16 *pixels = (__global const lanes16 *)(row + 8 * x);
        const ushort16 a = pixels[0], b = pixels[1], c = pixels[2], d = pixels[3];
        const uint16 red = convert_uint16((ushort16)(a.s048c, b.s048c, c.s048c, d.s048c));
        const uint16 green = convert_uint16((ushort16)(a.s159d, b.s159d, c.s159d, d.s159d));
        const uint16 blue = convert_uint16((ushort16)(a.s26ae, b.s26ae, c.s26ae, d.s26ae));
        *(__global lanes8 *)(out + x) = to_dn((red * 19595u + green * 38470u + blue * 7471u + 32768u) >> 16u);
    }
}
