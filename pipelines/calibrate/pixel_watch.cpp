/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "pixel_watch.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace dff {

void PixelWatch::add(const Sweep &sweep)
{
    constexpr int stands_out = 12; /* DN, at least */
    if (brighter_.size() != sweep.planes.front().size()) {
        brighter_ = cv::Mat1i::zeros(sweep.planes.front().size());
        darker_ = brighter_.clone();
        frames_ = poses_ = 0;
    }
    for (const cv::Mat1b &plane : sweep.planes) {
        cv::Mat1b around;
        cv::medianBlur(plane, around, 3);
        /* Noise reaches four times its usual difference now and then, but not in one place. */
        const int least = std::max(stands_out, cvRound(4.0 * cv::norm(plane, around, cv::NORM_L1) /
                                                       static_cast<double>(plane.total())));
        cv::add(brighter_, 1, brighter_, plane - around > least);
        cv::add(darker_, 1, darker_, around - plane > least);
        frames_++;
    }
    poses_++;
}

std::vector<cv::Point> PixelWatch::bad_pixels() const
{
    constexpr int fewest_poses = 3;
    std::vector<cv::Point> pixels;
    if (poses_ < fewest_poses)
        return pixels;
    cv::findNonZero(cv::max(brighter_, darker_) * 10 >= frames_ * 9, pixels);
    return pixels;
}

} // namespace dff
