/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_denoiser.h"
#include "focalstack/object_motion.h"

namespace dff {

/* Motion inside the sweep: turns the planes of one sweep, taken one after the other, into planes as if all
 * were taken at the middle of it. Objects that move are followed along their path; what they cover in a plane
 * is filled with the background that the denoiser has averaged. Where nothing moves, not a bit changes. */
class SweepFollower {
public:
    /* Of fewer an object covers its own background in most, and the path is worse than none. */
    static constexpr unsigned fewest_planes = 5;

    /* Throws std::invalid_argument for fewer planes. */
    explicit SweepFollower(const StackShape &shape);

    /* Before the sweep is denoised: looks for what moves. Gives the tiles of 8x8 pixels of each plane whose
     * background has to be kept, as StackDenoiser::denoise() takes them. `noise` of each component. */
    std::vector<uint8_t> look(const StackView &view, std::span<std::byte> memory, const DenoiseReport &noise);

    /* Afterwards: draws what moves where it is in the middle of the sweep, into `memory`. */
    void follow(const StackView &view, std::span<std::byte> memory, StackDenoiser &denoiser);

    void forget() { background_.forget(); }

    /* Part of the picture that moved in the last sweep, 0 to 1. */
    double moved() const { return silhouettes_.moved; }

private:
    StillBackground::Noise small_noise(const DenoiseReport &noise) const;
    std::vector<uint8_t> held_tiles();
    cv::Mat1f filled(unsigned z, const ObjectMotion &motion, double scale, const cv::Size &size) const;
    void follow_component(size_t c, const std::vector<std::vector<cv::Mat>> &pictures,
                          const ObjectMotion &motion, StackDenoiser &denoiser) const;

    StackShape shape_;
    SmallStack small_;
    StillBackground background_;
    Silhouettes silhouettes_;
    std::vector<cv::Mat1b> filled_; /* shows the background, unless an object is before it */
};

} // namespace dff
