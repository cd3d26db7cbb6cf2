/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/small_stack.h"

namespace dff {

/* Where one sweep differs from what stood still in those before; masks of 0 and 1, a plane each. */
struct Silhouettes {
    std::vector<cv::Mat1b> tight; /* certainly: the moving objects, sharp or blurred, each at its own time */
    std::vector<cv::Mat1b> wide;  /* perhaps */
    std::vector<cv::Mat1b> held;  /* wide, and what stood there before is known */
    std::vector<cv::Mat1b> known; /* what stands there is known, whether something is before it or not */
    double moved = 0.0;           /* part of the picture that is wide in any plane */
    bool is_whole = false;        /* the camera moved, or the scene is another: nothing is held or known */
};

/* What stands still, plane by plane (the same plane has the same blur), at SmallStack's size. A place that
 * differs keeps its background while something passes; when it has been the same for two sweeps, it is the
 * background. */
class StillBackground {
public:
    /* Noise of a small picture's pixels at 256 brightnesses, as a standard deviation, for each channel. */
    using Noise = std::vector<std::array<float, 256>>;

    /* Compares the sweep with the ones before and learns from it. */
    Silhouettes follow(const SmallStack &sweep, const Noise &noise);

    void forget() { planes_.clear(); }

private:
    struct Plane {
        std::vector<cv::Mat1f> background, last; /* a channel each */
        cv::Mat1b sweeps;                        /* that background is the mean of */
        cv::Mat1b known;                         /* background was seen twice */
        cv::Mat1b steady;                        /* as in the sweep before */
        cv::Mat1f same;                          /* sweeps that a place has differed and been steady */
    };

    void begin(const SmallStack &sweep);
    static void compare(const Plane &plane, const SmallStack &sweep, unsigned z, const Noise &noise,
                        cv::Mat1b &tight, cv::Mat1b &wide);
    static void look_for_steady(Plane &plane, const SmallStack &sweep, unsigned z, const Noise &noise,
                                cv::Mat1b &tight, const cv::Mat1b &wide);
    cv::Mat1f halted_sweeps(const Silhouettes &found);
    static void learn(Plane &plane, const SmallStack &sweep, unsigned z, const cv::Mat1f &halt,
                      const cv::Mat1b &wide, cv::Mat1b &held);

    std::vector<Plane> planes_;
    bool was_whole_ = false;
};

} // namespace dff
