/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/small_stack.h"

#include <array>

namespace dff {

/* Where one sweep differs from what stood still in those before; masks of 0 and 1, a plane each. */
struct Silhouettes {
    cv::Rect where;               /* outside of it no mask but `known` is set; empty if nothing moves */
    std::vector<cv::Mat1b> tight; /* certainly: the moving objects, sharp or blurred, each at its own time */
    std::vector<cv::Mat1b> wide;  /* perhaps */
    std::vector<cv::Mat1b> held;  /* wide, and what stood there before is known */
    std::vector<cv::Mat1b> known; /* what stands there is known, whether something is before it or not */
    double moved = 0.0;           /* part of the picture that is wide in any plane */
    bool is_whole = false;        /* the camera moved, or the scene is another: nothing is held or known */
};

/* What stands still, plane by plane (the same plane has the same blur), at SmallStack's size. A place that
 * differs keeps its background while something passes; when it has been the same for two sweeps, it is the
 * background.
 *
 * Each sweep costs one look at all pixels, for what certainly differs, and one to learn; all else is done
 * around what moves. Buffers are kept from sweep to sweep. */
class StillBackground {
public:
    /* Noise of a small picture's pixels at 256 brightnesses, as a standard deviation, for each channel. */
    using Noise = std::vector<std::array<float, 256>>;

    /* Takes the pictures of a stack into `sweep`, compares it with the ones before and learns from it; `last`
     * is the sweep that it was given before. Planes whose bit is set in `absent` do not show what they
     * should: they have no silhouettes, and tell nothing. What it gives is good until the next sweep. */
    const Silhouettes &follow(const StackPictureViews &pictures, SmallStack &sweep, const SmallStack &last,
                              const Noise &noise, uint64_t absent = 0);

    void forget() { planes_.clear(); }

    const Silhouettes &found() const { return found_; }

    const cv::Mat1f &plane(unsigned z, unsigned channel) const { return planes_[z].background[channel]; }

private:
    struct Plane {
        std::vector<cv::Mat1f> background; /* a channel each */
        cv::Mat1b sweeps;                  /* that background is the mean of */
        cv::Mat1b known;                   /* background was seen twice */
        cv::Mat1b steady;                  /* as in the sweep before */
        cv::Rect steady_where;             /* where that was looked for */
        cv::Mat1f same;                    /* sweeps that a place has differed and been steady */
        cv::Mat1b raw;                     /* what a silhouette is made of */
        cv::Rect outline;                  /* of the tight silhouette */
    };

    void begin(const SmallStack &sweep);
    void clear(const SmallStack &sweep);
    void find_certain(const StackPictureViews &pictures, SmallStack &sweep, unsigned z, const Noise &noise);
    void find_perhaps(const SmallStack &sweep, unsigned z, const Noise &noise, const cv::Mat1b &near);
    void look_for_steady(const SmallStack &sweep, const SmallStack &last, unsigned z, const Noise &noise);
    cv::Mat1b near_objects() const;
    double moved_part() const;
    cv::Mat1f halted_sweeps(const cv::Rect &where, uint64_t absent);
    void learn(const SmallStack &sweep, unsigned z, const cv::Mat1f &halt, const cv::Rect &halt_where);

    std::vector<Plane> planes_;
    Silhouettes found_;
    cv::Rect last_where_; /* of the sweep before */
    bool was_whole_ = false;
};

} // namespace dff
