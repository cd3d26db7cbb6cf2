/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/small_stack.h"

#include <gtest/gtest.h>

using namespace dff;

namespace {

/* A slope from black at the left border to white at the right one, in all components. */
std::vector<std::byte> slope(const StackShape &shape)
{
    std::vector<std::byte> memory(bytes_of(shape));
    const StackView view{shape, memory, packed_layout(shape)};
    for (auto &plane : pictures_of(view, memory))
        for (cv::Mat &picture : plane)
            for (int x = 0; x < picture.cols; x++)
                picture.col(x) = cv::Scalar::all((x + 0.5) * 255.0 / picture.cols);
    return memory;
}

} // namespace

TEST(SmallStack, each_pixel_is_the_mean_of_its_own_whatever_the_width)
{
    for (const PixelFormat format : {PixelFormat::Gray8, PixelFormat::I420, PixelFormat::Rgbx})
        for (const uint32_t width : {64U, 1000U, 2000U, 4096U, 8192U, 16384U}) {
            const StackShape shape{format, width, 64, 2};
            std::vector<std::byte> memory = slope(shape);
            SmallStack small(shape);
            small.take(pictures_of({shape, memory, packed_layout(shape)}, memory));
            EXPECT_LE(small.size().width, 512);
            for (unsigned channel = 0; channel < small.channels(); channel++) {
                const cv::Mat1f &picture = small.picture(1, channel);
                for (int x = 0; x < picture.cols; x++)
                    EXPECT_NEAR(picture(picture.rows - 1, x), (x + 0.5) * small.factor() * 255.0 / width, 4.5)
                        << width << " pixels, channel " << channel << ", pixel " << x;
            }
        }
}
