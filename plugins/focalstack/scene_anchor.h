/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/plane_warp.h"

namespace dff {

/* Finds where each of many stacks lies in the scene that a shaking hand shows, so that whoever averages
 * stacks finds the same places again. Whole pixels of it stay, for they cost no resampling of what was
 * averaged before; the rest, parts of a pixel, turn and zoom, is to be undone with what each plane's
 * alignment undoes.
 *
 * Middle planes are matched with that of one stack, the anchor, so that no error adds up. Where one cannot be
 * matched, has turned or zoomed by more than its border bears, or has left the anchor's picture, it becomes
 * the anchor. */
class SceneAnchor {
public:
    /* How the next stack's middle plane differs from what it should show: a point of that is found at
     * rest(point) in it. `picture` is its first component. */
    PlaneWarp rest_of(const cv::Mat &picture);

    /* Of the last stack: its pixel p shows what the anchor's pixel p + shift() shows. Even numbers, as chroma
     * may have half the size. */
    cv::Point shift() const { return shift_; }
    unsigned anchors() const { return anchors_; } /* so far: the same number, the same anchor */

    void forget() { anchor_.release(); }

private:
    PlaneWarp anchor(const cv::Mat &picture);

    cv::Mat anchor_;
    cv::Point shift_;
    unsigned anchors_ = 0;
};

} // namespace dff
