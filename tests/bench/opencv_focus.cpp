/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "opencv_focus.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff::bench {

namespace {

cv::Mat plane_of(std::span<const uint8_t> luma, int width, int height, int z)
{
    return {height, width, CV_8U,
            const_cast<uint8_t *>(luma.data()) + size_t(z) * width * height}; /* only read */
}

cv::Mat gradient(const cv::Mat &picture)
{
    cv::Mat dx, dy, magnitude;
    cv::Sobel(picture, dx, CV_32F, 1, 0, 3, 1.0 / 8);
    cv::Sobel(picture, dy, CV_32F, 0, 1, 3, 1.0 / 8);
    cv::magnitude(dx, dy, magnitude);
    return magnitude;
}

} // namespace

double opencv_focus_measure(std::span<const uint8_t> luma, int width, int height, int planes)
{
    cv::Mat best = cv::Mat::zeros(height, width, CV_32F), sum = best.clone();
    cv::Mat best_plane = cv::Mat::zeros(height, width, CV_8U);
    for (int z = 0; z < planes; z++) {
        const cv::Mat plane = plane_of(luma, width, height, z);
        cv::Mat product = gradient(plane);
        for (const int factor : {2, 3}) {
            cv::Mat coarse, fine;
            cv::resize(plane, coarse, {width / factor, height / factor}, 0, 0, cv::INTER_AREA);
            cv::resize(gradient(coarse), fine, {width, height}, 0, 0, cv::INTER_LINEAR);
            product = product.mul(fine);
        }
        best_plane.setTo(z, product > best);
        cv::max(best, product, best);
        sum += product;
    }
    return cv::sum(sum)[0] + cv::sum(best_plane)[0];
}

double opencv_entropy(std::span<const uint8_t> luma, int width, int height, int planes)
{
    constexpr double bin_width = 16.0, threshold_bits = 2.0, nothing = 1e-6;
    cv::Mat entropy = cv::Mat::zeros(height, width, CV_32F);
    for (int bin = 0; bin < 16; bin++) {
        cv::Mat count = cv::Mat::zeros(height, width, CV_8U), inside, share, log;
        for (int z = 0; z < planes; z++) {
            cv::inRange(plane_of(luma, width, height, z), bin * bin_width, (bin + 1) * bin_width - 1, inside);
            cv::add(count, 1, count, inside);
        }
        count.convertTo(share, CV_32F, 1.0 / planes, nothing);
        cv::log(share, log);
        entropy -= share.mul(log, 1.0 / std::log(2.0));
    }
    return cv::countNonZero(entropy > threshold_bits);
}

} // namespace dff::bench
