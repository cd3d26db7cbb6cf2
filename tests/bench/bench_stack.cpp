/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "bench_stack.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace dff::bench {

namespace {

/* Texture of several sizes on slow changes of light. */
cv::Mat textured_picture(int width, int height)
{
    cv::RNG random(1);
    cv::Mat sum = cv::Mat::zeros(height, width, CV_32F);
    for (const int size : {2, 8, 64}) {
        cv::Mat coarse(height / size + 1, width / size + 1, CV_32F), fine;
        random.fill(coarse, cv::RNG::UNIFORM, -35.0f, 35.0f);
        cv::resize(coarse, fine, {width, height}, 0, 0, cv::INTER_CUBIC);
        sum += fine;
    }
    return sum + 128.0f;
}

} // namespace

BenchStack::BenchStack(uint32_t width, uint32_t height, uint32_t planes)
    : shape{PixelFormat::I420, width, height, planes}, layout(packed_layout(shape))
{
    const int w = static_cast<int>(width), h = static_cast<int>(height), n = static_cast<int>(planes);
    const size_t plane_bytes = size_t{width} * height, picture_bytes = plane_bytes + plane_bytes / 2;
    memory.assign(picture_bytes * planes, std::byte{128});
    luma.resize(plane_bytes * planes);

    const cv::Mat sharp = textured_picture(w, h);
    for (int blur = 0; blur < n; blur++) {
        cv::Mat blurred = sharp, bytes;
        if (blur)
            cv::blur(sharp, blurred, {2 * blur + 1, 2 * blur + 1});
        blurred.convertTo(bytes, CV_8U);
        for (int z = 0; z < n; z++)
            for (int band = 0; band < n; band++)
                if (std::abs(z - band) == blur) {
                    const cv::Rect area(band * w / n, 0, (band + 1) * w / n - band * w / n, h);
                    bytes(area).copyTo(cv::Mat(h, w, CV_8U, luma.data() + z * plane_bytes)(area));
                }
    }
    for (uint32_t z = 0; z < planes; z++)
        std::copy_n(reinterpret_cast<const std::byte *>(luma.data()) + z * plane_bytes, plane_bytes,
                    memory.begin() + static_cast<std::ptrdiff_t>(layout[z].offset));
}

} // namespace dff::bench
