/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_follower.h"

#include <cmath>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

using namespace dff;

namespace {

constexpr int width = 320, height = 240, planes = 6, radius = 36;
constexpr float colour = 200.0F;
constexpr double speed = 3.0, noise = 6.0; /* pixels a plane; standard deviation */
const StackShape shape = {PixelFormat::Gray8, width, height, planes};

/* A disk without texture that is sharp in plane 1, before a texture. */
cv::Mat1f plane_of(unsigned z, double time)
{
    cv::Mat1f disk = cv::Mat1f::zeros(height, width), plane(height, width);
    constexpr int parts = 16; /* of a pixel */
    cv::circle(disk, cv::Point(cvRound((50.0 + speed * time) * parts), height / 2 * parts), radius * parts,
               1.0, cv::FILLED, cv::LINE_AA, 4);
    const int blur = 2 * std::abs(static_cast<int>(z) - 1);
    if (blur > 0)
        cv::blur(disk, disk, {2 * blur + 1, 2 * blur + 1});
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const auto behind =
                static_cast<float>(100.0 + 30.0 * std::sin(0.21 * x + 0.05 * y) + 25.0 * std::sin(0.13 * y));
            plane(y, x) = behind + disk(y, x) * (colour - behind);
        }
    return plane;
}

/* All planes at their own times, or at the middle of the sweep. */
std::vector<std::byte> sweep_of(unsigned number, bool is_still, double deviation)
{
    std::vector<std::byte> memory(bytes_of(shape));
    cv::RNG random(number + 1);
    for (unsigned z = 0; z < planes; z++) {
        const double time = number * planes + (is_still ? (planes - 1) / 2.0 : z);
        cv::Mat1f grain(height, width);
        random.fill(grain, cv::RNG::NORMAL, 0.0, deviation);
        const cv::Mat1f plane = plane_of(z, time) + grain;
        plane.convertTo(
            cv::Mat1b(height, width, reinterpret_cast<uchar *>(memory.data()) + size_t{z} * width * height),
            CV_8U);
    }
    return memory;
}

cv::Mat1b picture(std::vector<std::byte> &memory, unsigned z)
{
    return {height, width, reinterpret_cast<uchar *>(memory.data()) + size_t{z} * width * height};
}

/* Root mean square of the difference between two distances from the disk's centre. */
double difference(std::vector<std::byte> &a, std::vector<std::byte> &b, unsigned sweep, unsigned z, int from,
                  int to)
{
    const cv::Point center(cvRound(50.0 + speed * (sweep * planes + (planes - 1) / 2.0)), height / 2);
    cv::Mat1b ring = cv::Mat1b::zeros(height, width);
    cv::circle(ring, center, to, 255, cv::FILLED);
    if (from > 0)
        cv::circle(ring, center, from, 0, cv::FILLED);
    return cv::norm(picture(a, z), picture(b, z), cv::NORM_L2, ring) / std::sqrt(cv::countNonZero(ring));
}

} // namespace

/* Nothing but the blur of its rim tells how deep it lies, and noise would pass for texture. */
TEST(PlainObjects, keep_the_blur_of_their_rims_and_lose_their_noise)
{
    StackDenoiser denoiser(Device::open(""), shape);
    SweepFollower follower(shape);
    DenoiseReport report;
    for (unsigned t = 0; t < 9; t++) {
        auto memory = sweep_of(t, false, noise);
        const StackView view = {shape, memory, packed_layout(shape)};
        const auto held = follower.look(view, memory, report);
        denoiser.denoise(view, memory, 0, {16, 1.0F}, held);
        report = denoiser.report();
        follower.follow(view, memory, denoiser);
        if (t < 7)
            continue;
        auto truth = sweep_of(t, true, 0.0);
        for (unsigned z = 0; z < planes; z++) {
            EXPECT_LT(difference(memory, truth, t, z, 0, radius - 14), 1.5) << "inside, plane " << z;
            EXPECT_LT(difference(memory, truth, t, z, radius - 12, radius + 12), 12.0) << "rim, plane " << z;
        }
    }
}
