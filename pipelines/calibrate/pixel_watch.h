/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "sweep_reader.h"

namespace dff {

/* Looks for pixels of the sensor that stand out from their neighbours whatever is before them, and in all
 * planes: what the scene has blurs in some of them, a pixel does not. */
class PixelWatch {
public:
    /* A sweep of each pose of the board: what stands out in one may be the board. */
    void add(const Sweep &sweep);

    /* Those that stood out, to the same side, in nine tenths of the frames; nothing from less than three
     * poses. */
    std::vector<cv::Point> bad_pixels() const;

private:
    cv::Mat1i brighter_, darker_; /* frames in which each pixel was so */
    int frames_ = 0, poses_ = 0;
};

} // namespace dff
