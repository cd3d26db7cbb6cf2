/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "bench_stack.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace dff::bench {

namespace {

/* Texture of some sizes, in pixels, about `middle`. */
cv::Mat textured_picture(cv::RNG &random, cv::Size picture, std::initializer_list<int> sizes, float amplitude)
{
    cv::Mat sum(picture, CV_32F, cv::Scalar(128.0));
    for (const int size : sizes) {
        cv::Mat coarse(picture.height / size + 1, picture.width / size + 1, CV_32F), fine;
        random.fill(coarse, cv::RNG::UNIFORM, -amplitude, amplitude);
        cv::resize(coarse, fine, picture, 0, 0, cv::INTER_CUBIC);
        sum += fine;
    }
    return sum;
}

/* Writes the planes of a component: of `planes` bands of the sharp picture, one is sharp in each plane and
 * blurred by `blur_step` more a plane elsewhere. */
void paint(const cv::Mat &sharp, int blur_step, std::vector<cv::Mat> planes)
{
    const int n = static_cast<int>(planes.size());
    for (int blur = 0; blur < n; blur++) {
        cv::Mat blurred = sharp, bytes;
        if (blur)
            cv::blur(sharp, blurred, {blur_step * blur + 1, blur_step * blur + 1});
        blurred.convertTo(bytes, CV_8U);
        for (int z = 0; z < n; z++)
            for (int band = 0; band < n; band++)
                if (std::abs(z - band) == blur) {
                    const cv::Range columns(band * sharp.cols / n, (band + 1) * sharp.cols / n);
                    bytes.colRange(columns).copyTo(planes[z].colRange(columns));
                }
    }
}

} // namespace

BenchStack::BenchStack(const StackShape &described)
    : shape(described), layout(packed_layout(shape)), memory(bytes_of(shape))
{
}

BenchStack::BenchStack(uint32_t width, uint32_t height, uint32_t planes)
    : BenchStack({PixelFormat::I420, width, height, planes})
{
    const std::vector<Component> components = shape.components();
    const auto planes_of = [&](size_t component) {
        const Component &c = components[component];
        std::vector<cv::Mat> pictures;
        for (uint32_t z = 0; z < planes; z++)
            pictures.emplace_back(static_cast<int>(c.height), static_cast<int>(c.width), CV_8U,
                                  memory.data() + layout[component * planes + z].offset);
        return pictures;
    };
    cv::RNG random(1);
    const cv::Size pixels(static_cast<int>(width), static_cast<int>(height));
    paint(textured_picture(random, pixels, {2, 8, 64}, 35.0f), 2, planes_of(0));
    for (const size_t chroma : {1, 2})
        paint(textured_picture(random, pixels / 2, {4, 32, 128}, 20.0f), 1, planes_of(chroma));
    for (const cv::Mat &plane : planes_of(0))
        luma.insert(luma.end(), plane.datastart, plane.dataend);
}

BenchStack BenchStack::in_deep_colour() const
{
    BenchStack deep({PixelFormat::Rgba64, shape.width, shape.height, shape.planes});
    const int width = static_cast<int>(shape.width), height = static_cast<int>(shape.height);
    for (uint32_t z = 0; z < shape.planes; z++) {
        const cv::Mat plane(height * 3 / 2, width, CV_8U,
                            const_cast<std::byte *>(memory.data()) + layout[z].offset); /* only read */
        cv::Mat colours, target(height, width, CV_16UC4, deep.memory.data() + deep.layout[z].offset);
        cv::cvtColor(plane, colours, cv::COLOR_YUV2RGBA_I420);
        colours.convertTo(target, CV_16U, 257.0);
    }
    return deep;
}

} // namespace dff::bench
