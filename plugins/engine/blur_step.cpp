/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/blur_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace dff {

namespace {

/* rho beside log2 of the blur step in cells. */
constexpr std::array<std::pair<float, float>, 5> falls_by_step{
    {{0.93f, -1.0f}, {0.82f, 0.0f}, {0.60f, 1.0f}, {0.30f, 2.0f}, {0.10f, 3.0f}}};

constexpr float softening_of_stack = 0.4f, softening_of_levels = 1.0f;
constexpr float usual_step = 2.0f;   /* where nothing tells */
constexpr float least_rise = 0.15f;  /* of rho from one scale to the next, where blur is what falls */
constexpr float noise_alone = 0.25f; /* below, a fine scale may see nothing but noise */
constexpr float most_telling = 0.60f;

float log_step_of(float rho)
{
    if (rho >= falls_by_step.front().first)
        return falls_by_step.front().second;
    for (size_t i = 1; i < falls_by_step.size(); i++) {
        const auto [upper, upper_log] = falls_by_step[i - 1];
        const auto [lower, lower_log] = falls_by_step[i];
        if (rho >= lower)
            return upper_log + (upper - rho) / (upper - lower) * (lower_log - upper_log);
    }
    return falls_by_step.back().second;
}

} // namespace

BlurStep::BlurStep(CommandQueue &queue, const FocusPyramid &pyramid)
    : queue_(queue), floor_(queue.allocate(sizeof(cl_float)))
{
    const Program program(queue.device(), "blur_step");
    find_least_ = program.kernel("find_least");
    find_peaks_ = program.kernel("find_peaks");
    judge_peaks_ = program.kernel("judge_peaks");
    quantile_ = Program(queue.device(), "cost_volume").kernel("quantile");
    const LowShape &finest = pyramid.levels().front().shape;
    for (cl::Buffer *picture : {&least_, &strength_, &ratio_})
        *picture = finest.allocate(queue, 1);
    for (size_t i = 0; i <= pyramid.levels().size(); i++)
        rhos_.push_back(queue.allocate(sizeof(cl_float)));
}

float BlurStep::step_of(std::span<const Fall> falls)
{
    float step = 0.0f, distance = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < falls.size(); i++) {
        const auto [scale, rho, softened] = falls[i];
        if (rho > 1.0f)
            continue;
        if (std::abs(rho - most_telling) < distance) {
            distance = std::abs(rho - most_telling);
            step = scale * softened * std::exp2(log_step_of(rho));
        }
        /* Coarser scales tell more of little, and nothing of what is no blur. */
        const bool rises =
            std::adjacent_find(falls.begin() + static_cast<std::ptrdiff_t>(i), falls.end(),
                               [](const Fall &finer, const Fall &coarser) {
                                   return coarser.rho > finer.rho + least_rise && coarser.rho <= 1.0f;
                               }) != falls.end();
        if (rho >= most_telling || (rho > noise_alone && !rises))
            break;
    }
    return step;
}

BlurStep::Blur BlurStep::read(const FocusVolume &focus, const FocusPyramid &pyramid,
                              const NoiseEstimate &noise, const Blur &last)
{
    queue_.begin_stage("blur-step");
    falls_ = {{1.0f, 0.0f, softening_of_stack}};
    measure(focus.volume(), pyramid.levels().front().shape, 0);
    for (const FocusPyramid::Level &level : pyramid.levels()) {
        measure(level.focus, level.shape, falls_.size());
        falls_.push_back({static_cast<float>(level.shape.scale), 0.0f, softening_of_levels});
    }
    NoiseEstimate::Noise found{};
    queue_.commands().enqueueReadBuffer(noise.noise(), CL_FALSE, 0, sizeof found, &found);
    for (size_t i = 0; i < falls_.size(); i++)
        queue_.commands().enqueueReadBuffer(rhos_[i], CL_FALSE, 0, sizeof(cl_float), &falls_[i].rho);
    queue_.commands().finish();
    for (Fall &fall : falls_)
        fall.softened = 1.0f + found.t * fall.softened;
    const float step = step_of(falls_);
    if (step > 0.0f)
        return {step, found.t};
    return {last.step > 0.0f ? last.step : usual_step, found.t};
}

void BlurStep::measure(const cl::Buffer &focus, const LowShape &shape, size_t level)
{
    queue_.run(find_least_, shape.rows(), focus, least_, shape.width, shape.stride, shape.planes);
    queue_.run(quantile_, {1}, least_, floor_, 0.5f, 1.0f, shape.width, shape.height, shape.stride);
    queue_.run(find_peaks_, shape.rows(), focus, floor_, strength_, ratio_, shape.width, shape.stride,
               shape.planes);
    queue_.run(judge_peaks_, {1}, strength_, ratio_, rhos_[level], shape.width, shape.height, shape.stride);
}

} // namespace dff
