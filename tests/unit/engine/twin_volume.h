/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/noise_estimate.h"
#include "test_stack.h"

#include <array>

/* Plain C++ twins of the kernels of method=volume, on pictures without sides. Each takes what the stage
 * before it gave. */
namespace dff::twin {

using Noise = NoiseEstimate::Noise;
using Colours = std::array<Volume, 3>; /* R, G, B */

Volume mean_of_colours(const TestStack &stack); /* DN; luma itself where there is luma */
Volume average_squares(const Volume &planes, unsigned scale);
Volume fine_focus(const Volume &luma, const Noise &noise, unsigned scale);
Volume smooth_along_z(const Volume &focus, float t);
Volume fine_cost(const Volume &focus, float median_top, float t);
Volume coarse_focus(const Colours &small);
Volume cost(const Volume &fine_cost, const Volume &fine, const Volume &coarse, float median_fine_range,
            float median_range, float t);
Volume widen(const Volume &coarse, int spacing);
Volume first_guess(const Volume &cost, const Volume &fine, const Volume &wide, float median_fine_range,
                   float median_range);

float median(std::vector<float> values);
Volume range_of(const Volume &focus);
Volume top_of(const Volume &focus);

Volume median_5x5(const Volume &u);
Volume nearest_3x3(const Volume &u);
Colours blend(const Colours &small, const Volume &u, float t);
Colours denoise(const Colours &guide, float sigma, unsigned scale);
Volume guided_filter(const Volume &cost, const Colours &guide, float t);
/* kernels/seen_through.cl; costs in 1024ths, the others in DN. */
Volume prefer(const Volume &cost, const Volume &top, float median_top, float t, bool from_far);
Volume doubt_nearer(const Volume &filtered, const Volume &nearer, float t);
Volume match(const Volume &cost, const Colours &guide, float t);
Volume decide(const Volume &total, float t);
Volume mean_over_planes(const Volume &cost);
Volume fill(const Volume &u, const Volume &confidence, const Colours &guide, float high_confidence, float t,
            float blur_step);
/* One standard deviation of u; `decided`: before the fill; `matched`: before its place between planes;
 * `evidence`: what the fill's smoothing left of the squares of the confidence.
 */
Volume deviation(const Volume &u, const Volume &decided, const Volume &matched, const Volume &evidence,
                 float high_confidence, const Volume &cost, float t);
Volume upsample(const Volume &u, const Colours &guide, const Colours &planes, float t, unsigned scale);
std::vector<uint8_t> upsample_confidence(const Volume &confidence, unsigned width, unsigned height,
                                         unsigned scale);
std::vector<uint16_t> keep_confident(const std::vector<uint16_t> &depth,
                                     const std::vector<uint8_t> &confidence,
                                     const std::vector<uint8_t> *moved, float high_confidence);

/* What follows the blur step, in twin_volume_blur.cpp. */
Volume mean_of_small(const Colours &small);
Volume focus_on_scale(const Volume &luma, float t);
Volume least_over_planes(const Volume &focus);
float quantile(std::vector<float> values, double share);
float fall_beside_peaks(const Volume &focus);
Volume without_leak(const Volume &focus, float middle, float blur_step, unsigned scale, float t);
/* c0, c1, c2 and the ends of its brightnesses, in the kernel's units of focus. */
std::vector<float> noise_curve(const Volume &focus, const Colours &small);
std::vector<float> not_fallen_deep(std::vector<float> curve);
Volume even_noise(const Volume &focus, const Colours &small, const std::vector<float> &curve, float t);
Volume doubt_nearer_side(const Volume &confidence, const Volume &u, const Volume &cost, float blur_step,
                         unsigned scale, float t);
Volume refine(const Volume &u, const Volume &focus, int apart, float t);
std::vector<uint16_t> limit_depth(const std::vector<uint16_t> &depth, unsigned width, unsigned height,
                                  unsigned block, float blur_step, unsigned planes);

} // namespace dff::twin
