/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * What noise leaves in fine focus grows with the brightness I of a place, as light's own noise does: where blur brings
 * bright surroundings into a dark place, those planes alone are noisier there and would pass for sharp. n(I), a parabola,
 * goes through the tenth least of all planes' focus at each of BINS brightnesses, weighed by the root of their count; then
 *
 *     F_z <- max(F_z - (3 - 1.8t) (n(I_z) - mean_z n(I_z)), 0)
 *
 * so that planes are alike in noise while a place keeps what it has over all planes, which the costs go by. Where all that
 * is of one brightness has texture, as on a board of squares, n(I) is no noise: at most three times the least focus of the
 * place over all planes is added or taken. Nor is it where n(I) falls deep, as from a desk to a blank wall that is brighter:
 * a parabola that is highest at V counts from where it has fallen to 3/4 V as that.
 */
#include "low_picture.cl"

#define BINS 16
#define LEVELS 192 /* 16 an octave of 1 + focus */
#define SHIFT 19   /* of a float's bits, to levels */
#define LEAST_COUNT 50
#define WHITE (3 * COLOUR_ONE * 256) /* the three colours' sum */
#define DEEPEST_FALL 0.25f /* of V */
#define EXCESS(noise) (3.0f - 1.8f * (noise)->t)

/* Of a histogram of `count` values of focus, which a tenth is below. */
INLINE float tenth_least(const uint *histogram, uint count)
{
    float wanted = 0.1f * count;
    int level = 0;
    while (level < LEVELS - 1 && wanted > histogram[level])
        wanted -= histogram[level++];
    const float place = level + wanted / max(histogram[level], 1u);
    return as_float(as_uint(1.0f) + (uint)(place * (1 << SHIFT))) - 1.0f;
}

/* Sums over the brightnesses: power[k] of weight I^k, value[k] of weight I^k n. */
typedef struct {
    float power[5], value[3];
} Moments;

INLINE void add_moments(Moments *m, float weight, float brightness, float noise)
{
    for (int k = 0; k < 5; k++) {
        m->power[k] += weight;
        if (k < 3)
            m->value[k] += weight * noise;
        weight *= brightness;
    }
}

/* The parabola of least squares, which bends little where there are few brightnesses. */
INLINE void fit_parabola(Moments *m, __global float *curve)
{
    float *s = m->power;
    s[2] += 1e-3f * s[0];
    s[4] += 1e-3f * s[0];
    const float a = s[2] * s[4] - s[3] * s[3], b = s[2] * s[3] - s[1] * s[4], c = s[1] * s[3] - s[2] * s[2];
    const float d = s[0] * s[4] - s[2] * s[2], e = s[1] * s[2] - s[0] * s[3], f = s[0] * s[2] - s[1] * s[1];
    const float scale = 1.0f / max(s[0] * a + s[1] * b + s[2] * c, 1e-20f);
    curve[0] = scale * (a * m->value[0] + b * m->value[1] + c * m->value[2]);
    curve[1] = scale * (b * m->value[0] + d * m->value[1] + e * m->value[2]);
    curve[2] = scale * (c * m->value[0] + e * m->value[1] + f * m->value[2]);
}

/* curve: n as curve[0] + curve[1] I + curve[2] I^2 in units of focus, I of 0..1 and between curve[3] and curve[4]. One
 * work-item; looks at every step-th cell in both directions. */
__kernel void find_curve(__global const short *focus, __global const short *small, __global float *curve, int width,
                         int height, int stride, int planes, int step)
{
    uint counts[BINS * LEVELS];
    for (int i = 0; i < BINS * LEVELS; i++)
        counts[i] = 0;
    const size_t picture = (size_t)height * stride;
    for (int z = 0; z < planes; z++)
        for (int y = z % step; y < height; y += step)
            for (int x = z % step; x < width; x += step) {
                const size_t cell = (size_t)y * stride + SIDE + x;
                __global const short *red = small + 3 * z * picture + cell;
                const int bin = (red[0] + red[picture] + red[2 * picture]) * BINS / WHITE;
                const uint bits = as_uint(1.0f + focus[z * picture + cell]) - as_uint(1.0f);
                counts[clamp(bin, 0, BINS - 1) * LEVELS + min(bits >> SHIFT, (uint)(LEVELS - 1))]++;
            }
    Moments moments = {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    float least = 1.0f, greatest = 0.0f;
    for (int i = 0; i < BINS; i++) {
        uint count = 0;
        for (int level = 0; level < LEVELS; level++)
            count += counts[i * LEVELS + level];
        if (count < LEAST_COUNT)
            continue;
        const float brightness = (i + 0.5f) / BINS;
        least = min(least, brightness);
        greatest = max(greatest, brightness);
        add_moments(&moments, sqrt((float)count), brightness, tenth_least(counts + i * LEVELS, count));
    }
    fit_parabola(&moments, curve);
    if (curve[2] < 0.0f) {
        const float vertex = -0.5f * curve[1] / curve[2], most = curve[0] + 0.5f * curve[1] * vertex;
        greatest = min(greatest, vertex + sqrt(DEEPEST_FALL * max(most, 0.0f) / -curve[2]));
    }
    curve[3] = least;
    curve[4] = max(least, greatest);
}

/* evened: F, its sides mirrored. Work-items (1, low height). */
__kernel void even_noise(__global const short *focus, __global const short *small, __global const float *curve,
                         __global const Noise *noise, __global short *evened, int width, int stride, int planes)
{
    const size_t row = get_global_id(1) * stride + SIDE, picture = get_global_size(1) * stride;
    const float slope = EXCESS(noise) * curve[1], bend = EXCESS(noise) * curve[2];
    for (int x = 0; x < width; x += 16) {
        int16 sum = 0;
        short16 least = SHRT_MAX;
        for (int z = 0; z < planes; z++) {
            __global const short *cells = small + 3 * z * picture + row + x;
            const float16 light = READ_WIDE_SHORTS(cells) + READ_WIDE_SHORTS(cells + picture) +
                                  READ_WIDE_SHORTS(cells + 2 * picture);
            const float16 i = clamp(light * (1.0f / WHITE), curve[3], curve[4]);
            const short16 excess = to_wide_shorts(i * (slope + bend * i));
            sum += convert_int16(excess);
            SHORTS(evened + z * picture + row + x) = excess;
            least = min(least, READ_SHORTS(focus + z * picture + row + x));
        }
        const short16 mean = to_wide_shorts(convert_float16(sum) / planes);
        const short16 limit = add_sat(least, add_sat(least, least));
        for (int z = 0; z < planes; z++) {
            __global short *out = evened + z * picture + row + x;
            const short16 taken = clamp(READ_SHORTS(out) - mean, -limit, limit);
            SHORTS(out) = max(READ_SHORTS(focus + z * picture + row + x) - taken, (short16)0);
        }
    }
    for (int z = 0; z < planes; z++)
        mirror_short_ends(evened + z * picture + row, width);
}
