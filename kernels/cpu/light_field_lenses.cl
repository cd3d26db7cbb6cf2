/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * The same as lenticular of light_field_panel.cl, for CPUs: a work-item is a strip of the panel's rows. Each subpixel has a
 * slope of its own. Rays through one point hit the relief in the order of their slopes: where the search begins is found for
 * a few sectors of the cone, once a row for all lenses. The rays of 16 pixels search in step, and those of their three channels
 * together, so that one's reads overlap with the others'.
 */
#include "light_field_row.cl"
#include "lanes16.cl"

#define SECTORS 4 /* sectors of even angles, from the middle to the edge of the cone, on each side */
#define ODD_LANES (int16)(0, -1, 0, -1, 0, -1, 0, -1, 0, -1, 0, -1, 0, -1, 0, -1)

/* The relief's row from one side. */
typedef struct {
    Row row;
    __global int *starts;    /* for each sector, where to begin at a place between x and x + 1 */
    __global int *shades[3]; /* of each channel, 256 times how much the next pixel has more than this, and this */
} Side;

/* tan(x) to the last digits of a float up to 60 degrees: Lambert's continued fraction. */
#define TAN(x, square) ((x) * (945.0f + (square) * ((square) - 105.0f)) / (945.0f + (square) * (15.0f * (square) - 420.0f)))

inline float sector_slope(int sector, float cone)
{
    const float angle = sector * cone / (2 * SECTORS);
    return TAN(angle, angle * angle);
}

/* places: an int a pixel. */
inline void find_starts(const Side *side, float cone, __global int *places)
{
    const int width = side->row.width;
    __global const float *height = side->row.height;
    for (int sector = 0; sector < SECTORS; sector++) {
        __global int *starts = side->starts + sector * PITCH(width);
        const float least = sector_slope(sector, cone), greatest = sector_slope(sector + 1, cone);
        for (int j = 0; j < width; j += 16) {
            const float16 high = *(__global const float16 *)(height + j);
            const float16 leftmost = LANES + (float)j - max(least * high, greatest * high);
            *(__global int16 *)(places + j) = clamp(convert_int16(leftmost), (int16)0, (int16)width);
            *(__global int16 *)(starts + j) = 0;
        }
        starts[width] = 0;
        for (int j = 0; j < width - 1; j++)
            starts[places[j]] = j;
        int16 before = 2; /* pixels stand before each where a search begins, as see_near() needs */
        for (int x = 0; x < width; x += 16) {
            before = max(greatest_so_far(*(__global const int16 *)(starts + x)), (int16)before.sf);
            *(__global int16 *)(starts + x) = before;
        }
    }
}

inline void find_shades(const Side *side)
{
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < side->row.width; j += 16) {
            const int16 here = as_int16(*(__global const uint16 *)(side->row.color + j) >> (8 * c) & 255);
            const int16 next = as_int16(*(__global const uint16_any *)(side->row.color + j + 1) >> (8 * c) & 255);
            *(__global int16 *)(side->shades[c] + j) = (next - here) * 256 + here;
        }
}

/* 16 rays that pass the places of a row where there is no parallax, mirrored if they lean to the left: then what they see lies
 * `offset` behind the row's arrays. */
typedef struct {
    float16 place, slope;
    int16 offset;
} Rays;

/* The pixel that each of 16 rays sees, or sees what lies between it and the next one, and their heights. */
typedef struct {
    float16 pixel, height, next;
} Seen;

INLINE Rays make_rays(const Row *row, const Row *mirrored, float16 s, float16 angle)
{
    const int16 turned = angle < 0.0f;
    const float16 square = angle * angle;
    const Rays rays = {turned ? row->width - 1 - s : s, fabs(TAN(angle, square)),
                       turned ? (int)(mirrored->height - row->height) : 0};
    return rays;
}

INLINE int16 goes_on(const Rays *rays, const Seen *seen)
{
    return seen->pixel - rays->slope * seen->height > rays->place;
}

/* Looks at three pixels at once from where the search begins, which is as far as most rays go. */
INLINE Seen see_near(__global const float *heights, const Rays *rays, int16 start)
{
    const int16 first = rays->offset + start;
    float16 after, at, before, last;
    gather_pairs(heights, first, &at, &after);
    gather_pairs(heights, first - 2, &last, &before);
    const float16 pixel = convert_float16(start), beyond = pixel - rays->place;
    const int16 one = beyond > rays->slope * at, two = one && beyond - 1.0f > rays->slope * before;
    const Seen seen = {pixel - (one ? 1.0f : 0.0f) - (two ? 1.0f : 0.0f), two ? last : one ? before : at,
                       two ? before : one ? at : after};
    return seen;
}

inline void see_farther(__global const float *heights, const Rays *rays, Seen *seen)
{
    int16 more = goes_on(rays, seen) && seen->pixel > 0.0f;
    while (any_of(more)) {
        seen->pixel = more ? seen->pixel - 1.0f : seen->pixel;
        const float16 here = GATHER(float16, heights, (rays->offset + convert_int16(seen->pixel)));
        seen->next = more ? seen->height : seen->next;
        seen->height = here;
        more = more && goes_on(rays, seen) && seen->pixel > 0.0f;
    }
}

INLINE float16 beside(const Rays *rays, const Seen *seen)
{
    return rays->place - (seen->pixel - rays->slope * seen->height);
}

INLINE int16 is_torn(const Layers *layers, const Rays *rays, const Seen *seen)
{
    return seen->height - seen->next > layers->step && beside(rays, seen) > TOUCH;
}

/* The channel c where rays look behind an edge, else `value`. */
inline float16 look_behind_edges(const Layers *layers, const Row *row, const Row *mirrored, const Rays *rays, const Seen *seen,
                                 int c, float16 value)
{
    const int16 torn = is_torn(layers, rays, seen) && rays->slope * (layers->heights.y - layers->heights.x) >= 1e-3f;
    for (int i = 0; i < 16; i++)
        if (EACH(const int, torn)[i]) {
            const float4 color =
                look_behind(EACH(const int, rays->offset)[i] ? mirrored : row, EACH(const float, rays->place)[i],
                            (int)EACH(const float, seen->pixel)[i], EACH(const float, rays->slope)[i], layers->step,
                            layers->heights.x, layers->fill);
            EACH(float, value)[i] = c == 0 ? color.x : c == 1 ? color.y : color.z;
        }
    return value;
}

/* The colours of 16 pixels at the places s, whose channels are seen at these angles. */
INLINE uint16 look_at(const Layers *layers, const Side *side, const Side *mirrored, float16 s, const float16 *angles,
                      float sectors)
{
    const Row *row = &side->row;
    Rays rays[3];
    Seen seen[3];
    int16 more = 0;
    for (int c = 0; c < 3; c++) {
        rays[c] = make_rays(row, &mirrored->row, s, angles[c]);
        const int16 sector = min(convert_int16(fabs(angles[c]) * sectors), (int16)(SECTORS - 1));
        const int16 start = GATHER(
            int16, side->starts, (rays[c].offset + sector * PITCH(row->width) + convert_int16(rays[c].place)));
        seen[c] = see_near(row->height, &rays[c], start);
        more |= goes_on(&rays[c], &seen[c]);
    }
    if (any_of(more))
        for (int c = 0; c < 3; c++)
            see_farther(row->height, &rays[c], &seen[c]);

    float16 values[3];
    int16 torn = 0;
    for (int c = 0; c < 3; c++) {
        const int16 shade = GATHER(int16, side->shades[c], (rays[c].offset + convert_int16(seen[c].pixel)));
        const float16 share = beside(&rays[c], &seen[c]) / (1.0f + rays[c].slope * (seen[c].height - seen[c].next));
        values[c] = convert_float16(shade & 255) + convert_float16(shade >> 8) * share;
        torn |= is_torn(layers, &rays[c], &seen[c]);
    }
    if (any_of(torn))
        for (int c = 0; c < 3; c++)
            values[c] = look_behind_edges(layers, row, &mirrored->row, &rays[c], &seen[c], c, values[c]);
    uint16 colors = OPAQUE;
    for (int c = 0; c < 3; c++)
        colors |= convert_uint16(convert_int16(values[c] + 0.5f)) << (8 * c);
    return colors;
}

/* Lays a side's arrays out in `scratch` and moves that behind them. */
inline Side make_side(__global uint **scratch, int width)
{
    const int pitch = PITCH(width);
    const Row row = make_row(scratch, width);
    __global int *shades = (__global int *)*scratch;
    const Side side = {row, shades + 3 * pitch, {shades, shades + pitch, shades + 2 * pitch}};
    *scratch += (3 + SECTORS) * pitch;
    return side;
}

/* Arguments as those of lenticular; and the row's first column and width, and scratch_size elements of scratch for each
 * work-item. Work-items (strips). */
__kernel void lenticular_rows(LAYERS, float pitch, float tilt, float center, float cone, __global const float *shifts,
                              int4 flips, int base, int width, __global uint *scratch, int scratch_size, float2 first,
                              float2 scale, __global uchar *output, ulong stride, int channels, int2 output_size)
{
    const Layers layers = MAKE_LAYERS;
    const int strip = (int)get_global_id(0), strips = (int)get_global_size(0);
    scratch += (size_t)strip * scratch_size;
    const Side side = make_side(&scratch, width), mirrored = make_side(&scratch, width);
    __global int *places = (__global int *)scratch;
    const float per_pixel = pitch / output_size.x, sectors = 2 * SECTORS / cone;
    int loaded = -1;
    for (int y = output_size.y * strip / strips; y < output_size.y * (strip + 1) / strips; y++) {
        const float point_y = clamp(first.y + scale.y * (flips.y ? output_size.y - 1 - y : y), 0.0f, size.y - 1.0f);
        const int nearest = convert_int_rte(point_y);
        if (nearest != loaded) {
            load_heights(&layers, nearest, base, &side.row, &mirrored.row);
            find_starts(&side, cone, places);
            find_starts(&mirrored, cone, places);
            loaded = nearest;
        }
        load_colors(&layers, point_y, base, &side.row, &mirrored.row);
        find_shades(&side);
        find_shades(&mirrored);
        const float from_bottom = 1.0f - (y + 0.5f) / output_size.y;
        const float start = 0.5f * per_pixel + tilt * from_bottom * pitch - center;
        __global const float *shift = shifts + 6 * (output_size.y - 1 - y & 3);
        __global uchar *line = output + stride * (ulong)y;
        for (int x = 0; x < output_size.x; x += 16) {
            const float16 column = min(LANES16 + (float)x, output_size.x - 1.0f);
            const float16 s = first.x + scale.x * (flips.x ? output_size.x - 1 - column : column) - base;
            float16 angles[3];
            for (int c = 0; c < 3; c++) {
                const float16 shifted = ODD_LANES ? (float16)shift[3 + c] : (float16)shift[c];
                const float16 lens = start + column * per_pixel + shifted * pitch;
                angles[c] = (lens - floor(lens) - 0.5f) * (flips.z ? -cone : cone);
            }
            const uint16 colors = look_at(&layers, &side, &mirrored, s, angles, sectors);
            put_colors(line, x, min(16, output_size.x - x), channels, colors);
        }
    }
}
