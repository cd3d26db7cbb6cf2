/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/shift_rivals.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace dff {
namespace {

/* Of the width and the height, at each side. */
constexpr double reach = 0.2;

/* Pixels: as far as this the correlation is that of the warp itself, by what is left of turn and zoom; and a
 * rival lies beyond the lobe around it, which is as wide as the band's lower end. */
constexpr int own_radius = 2;
constexpr int lobe_radius = 6;

/* Rivals within this margin of the warp's own correlation are as good, no better and no worse. */
constexpr double margin_below = 0.96;
constexpr double margin_above = 1.05;

/* Of the way to the rival: a camera on a stand moves less than this, a hand may do anything. */
constexpr double still = 0.12;

} // namespace

bool ShiftRival::wins(const PlaneWarp &warp, cv::Size size) const
{
    if (others > margin_above * own)
        return true;
    return others > margin_below * own && warp.largest_shift(size) > still * cv::norm(shift);
}

ShiftRival strongest_rival(const cv::Mat &from, const cv::Mat &to, const PlaneWarp &warp)
{
    const cv::Size size = from.size();
    const cv::Point margin(static_cast<int>(size.width * reach), static_cast<int>(size.height * reach));
    cv::Mat undone, mask, correlation;
    cv::warpPerspective(to, undone, warp.pixel_matrix(size), size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                        cv::BORDER_CONSTANT, cv::Scalar::all(128));
    cv::matchTemplate(undone, from(cv::Rect(margin, size - cv::Size(2 * margin))), correlation,
                      cv::TM_CCOEFF_NORMED);

    ShiftRival rival;
    double own = 0.0;
    const cv::Rect all({}, correlation.size());
    const auto around = [&](int radius) {
        return all & cv::Rect(margin.x - radius, margin.y - radius, 2 * radius + 1, 2 * radius + 1);
    };
    cv::minMaxLoc(correlation(around(own_radius)), nullptr, &own);
    correlation(around(lobe_radius)).setTo(-1.0);
    cv::Point place;
    cv::minMaxLoc(correlation, nullptr, &rival.others, nullptr, &place);
    rival.own = own;
    rival.shift = cv::Point2d(place - margin);
    return rival;
}

} // namespace dff
