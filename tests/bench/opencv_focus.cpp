/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "plain_focus.h"

#include <opencv2/imgproc.hpp>

namespace dff::bench {

namespace {

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
        const cv::Mat plane(height, width, CV_8U,
                            const_cast<uint8_t *>(luma.data()) + size_t(z) * width * height); /* only read */
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

} // namespace dff::bench
