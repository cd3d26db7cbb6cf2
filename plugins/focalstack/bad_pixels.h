/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace dff {

/* Pixels of the sensor that are too bright or too dark whatever is before them. They would pass for something
 * that is sharp in all planes, and hold fast what follows corners.
 *
 * A pixel is bad that stands out from all of its eight neighbours, to the same side, in nine tenths of the
 * planes, before three parts of the scene at least: what stands out before one only, such as a star, may be
 * the scene's own. Where two bad ones touch, neither is found; where more than one pixel of 400 stands out,
 * all planes show the same, and none is bad. */
class BadPixels {
public:
    /* Of fewer planes all may be sharp. */
    static constexpr std::size_t fewest_planes = 5;

    /* Learns from the planes of one sweep, as the sensor took them: pictures of one size with 8 or 16 bits
     * and any channels. Fewer planes tell nothing. */
    void look(std::span<const cv::Mat> planes);

    /* Those that are known to be bad: column and row. */
    std::span<const cv::Point> places() const { return places_; }

    /* The next sweep is another camera's. */
    void forget() { *this = {}; }

private:
    struct Suspect {
        cv::Point sample; /* column, counting channels one by one, and row */
        bool is_bright;
        int parts; /* of the scene, before which it stood out, less the sweeps in which it did not */
        bool is_bad;
        double around, brightness; /* mean of its neighbours, and of the picture, before the last part */
    };

    void add_suspects(std::span<const cv::Mat> planes);
    static void judge(Suspect &suspect, std::span<const cv::Mat> planes, double brightness);
    void tell_places(const cv::Mat &picture);

    std::vector<Suspect> suspects_; /* by rows */
    std::vector<cv::Point> places_;
    int slice_ = -1;           /* of the rows, that was searched last; -1 before all were */
    std::size_t searched_ = 0; /* plane */
};

/* Bad pixels become the median of their neighbours, in a component of a picture that has a sample for each
 * `step` x `step` pixels. */
void repair_pixels(cv::Mat picture, std::span<const cv::Point> places, int step = 1);

} // namespace dff
