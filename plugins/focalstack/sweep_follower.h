/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_denoiser.h"
#include "focalstack/object_drawing.h"
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
     * background has to be kept, as StackDenoiser::denoise() takes them: none where nothing moves. `noise` of
     * each component. Nothing is looked for in planes whose bit is set in `absent`, which do not show what
     * they should: such a sweep cannot be followed, but what stands behind is remembered through it. */
    std::span<const uint8_t> look(const StackView &view, std::span<std::byte> memory,
                                  const DenoiseReport &noise, uint64_t absent = 0);

    /* Afterwards: draws what moves where it is in the middle of the sweep, into `memory`. */
    void follow(const StackView &view, std::span<std::byte> memory, StackDenoiser &denoiser);

    void forget() { background_.forget(); }

    /* Part of the picture that moved in the last sweep, 0 to 1. */
    double moved() const { return background_.found().moved; }

private:
    StillBackground::Noise small_noise(const DenoiseReport &noise) const;
    /* What takes the place of what passes, in one component of one plane. */
    struct Fill {
        BackgroundPart background;
        cv::Rect where;  /* pixels of the component */
        cv::Mat1f share; /* 0 to 1, not clipped */
    };

    cv::Size tiles() const; /* of the denoiser, across and down */
    void hold_tiles();
    bool hold_tiles(unsigned z);
    ObjectsOfComponent objects_of(size_t component, const ObjectMotion &motion) const;
    Fill fill_of(size_t component, unsigned z, const ObjectMotion &motion) const;
    void compose(const cv::Mat &picture, unsigned z, const ObjectMotion &motion,
                 const ObjectsOfComponent &objects, Fill &fill) const;

    StackShape shape_;
    SmallStack small_, last_; /* this sweep and the one before */
    StillBackground background_;
    StillBackground::Noise noise_;
    std::vector<uint8_t> held_;     /* [plane][tile] */
    bool holds_ = false;            /* held_ has anything but 0 in it */
    std::vector<cv::Mat1b> filled_; /* shows the background, unless an object is before it */
    cv::Rect filled_where_;         /* outside of it nothing is filled */
};

} // namespace dff
