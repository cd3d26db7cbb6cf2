/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/noise_curve.h"
#include "test_stack.h"

namespace dff::twin {

/* stack_denoise.cl in plain words, in double: for stacks of one component, with the denoiser's own word for
 * the noise. */
class Denoiser {
public:
    explicit Denoiser(const StackShape &shape);

    void denoise(TestStack &stack, const NoiseCurve &curve, float spread, unsigned frames);

private:
    size_t tiles() const { return size_t{across_} * down_; }
    float samples() const { return static_cast<float>(width_ * rows_); }
    size_t mean_at(unsigned x, unsigned y, unsigned z) const;
    TileDifference difference(const TestStack &stack, unsigned z, unsigned tile) const;
    bool is_moved(const TileDifference &tile, const NoiseCurve &curve, unsigned sweeps, float spread) const;
    void count(std::vector<uint8_t> &sweeps, const std::vector<bool> &moved, unsigned frames) const;
    void average(TestStack &stack, unsigned z);

    StackShape shape_;
    Component component_;
    unsigned width_, rows_;  /* samples of a tile */
    unsigned across_, down_; /* tiles */
    std::vector<double> means_;
    std::vector<std::vector<uint8_t>> sweeps_; /* [z][tile] */
};

} // namespace dff::twin
