/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_shape.h"

#include <array>
#include <optional>
#include <span>

namespace dff {

/* The variance of a sensor's noise at 16 brightnesses: curve[i] is that of samples around (i + 1/2) / 16 of
 * white, in squares of their own unit. */
using NoiseCurve = std::array<float, 16>;

/* Between the brightnesses of the curve; white is 256. */
float variance_at(const NoiseCurve &curve, float brightness);

/* What a tile of pixels tells of noise, see kernels/stack_denoise.cl; laid out as its float4. */
struct TileDifference {
    float mean;       /* of sample - mean of the sweeps before */
    float square;     /* the mean square of it */
    float brightness; /* mean of the sweeps before */
    float unused;
};

/* How far noise may take a tile of `samples`: its mean by so many standard deviations of a sample, its mean
 * square to so many times its variance (chi-squared, after Wilson and Hilferty). `sigmas` of the mean, and
 * five where it has six of the square; `spread` as of spread_of_tiles(). */
float most_mean(float samples, float spread, float sigmas);
float most_square(float samples, float spread, float sigmas);

/* Noise of one picture by itself (after Immerkaer 1996): the lower quartile of |[1 -2 1] x [1 -2 1]| over the
 * pixels of a brightness, so that only three quarters of them may have texture. It is too high where more
 * have, and too low where neighbouring pixels are alike (demosaicing, JPEG). `component` of plane z. */
NoiseCurve noise_of_plane(const StackView &view, size_t component, uint32_t z);

/* Noise as it differs from sweep to sweep: the lower quartile over tiles of a brightness, each divided by
 * 1 + 1 / sweeps. It is too high where more than three quarters of the tiles moved. Empty without enough
 * tiles. */
std::optional<NoiseCurve> noise_of_tiles(std::span<const TileDifference> tiles,
                                         std::span<const uint8_t> sweeps, const Component &component,
                                         float samples);

/* How much less certain the mean of a tile is than that of as many independent samples: 1, or more. */
float spread_of_tiles(std::span<const TileDifference> tiles, float samples);

} // namespace dff
