/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_follower.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <random>

using namespace dff;

namespace {

constexpr int width = 320, height = 240, planes = 6, side = 56;
constexpr double middle = (planes - 1) / 2.0;

/* Where a square stands at a time in planes. */
using Path = std::function<cv::Point2d(double)>;

double background_at(double x, double y)
{
    return 110 + 30 * std::sin(0.21 * x + 0.05 * y) + 25 * std::sin(0.13 * y - 0.06 * x);
}

double square_at(double x, double y)
{
    return 190 + 30 * std::sin(0.33 * x) * std::sin(0.27 * y);
}

/* Planes of one sweep, whose times are given, of a square before a background, with noise. */
class Scene {
public:
    Scene(PixelFormat format, double sigma, unsigned count = planes)
        : shape_{format, width, height, count}, sigma_(sigma)
    {
    }

    const StackShape &shape() const { return shape_; }

    std::vector<std::byte> sweep(unsigned number, const Path &path) const
    {
        return draw([&](unsigned z) { return path(number * shape_.planes + static_cast<double>(z)); }, sigma_,
                    number + 1);
    }

    /* All planes at the middle of it, without noise. */
    std::vector<std::byte> still(unsigned number, const Path &path) const
    {
        return draw([&](unsigned) { return path(middle_of(number)); }, 0.0, 0);
    }

    double middle_of(unsigned sweep) const { return sweep * shape_.planes + (shape_.planes - 1) / 2.0; }

    StackView view(const std::vector<std::byte> &memory) const
    {
        return {shape_, memory, packed_layout(shape_)};
    }

private:
    template <typename Place>
    std::vector<std::byte> draw(const Place &place, double sigma, unsigned seed) const
    {
        std::vector<std::byte> memory(bytes_of(shape_));
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, std::max(sigma, 1e-9));
        const auto components = shape_.components();
        const auto layout = packed_layout(shape_);
        for (size_t c = 0; c < components.size(); c++)
            for (unsigned z = 0; z < shape_.planes; z++)
                for (unsigned y = 0; y < components[c].height; y++)
                    for (unsigned x = 0; x < components[c].width; x++) {
                        const Component &of = components[c];
                        const double px = (x / of.channels + 0.5) * of.subsampling - 0.5;
                        const double py = (y + 0.5) * of.subsampling - 0.5;
                        const cv::Point2d at = place(z);
                        const bool is_inside =
                            px >= at.x && py >= at.y && px < at.x + side && py < at.y + side;
                        const double value =
                            (is_inside ? square_at(px - at.x, py - at.y) : background_at(px, py)) +
                            (sigma > 0.0 ? noise(random) : 0.0);
                        const double unit = of.sample_bytes == 2 ? 256.0 : 1.0;
                        const auto sample =
                            static_cast<uint16_t>(std::lround(unit * std::clamp(value, 0.0, 255.0)));
                        const RowLayout &rows = layout[c * shape_.planes + z];
                        std::memcpy(memory.data() + rows.offset + rows.stride * y + x * of.sample_bytes,
                                    &sample, of.sample_bytes);
                    }
        return memory;
    }

    StackShape shape_;
    double sigma_;
};

/* Denoises and follows sweep after sweep. */
class Follower {
public:
    explicit Follower(const Scene &scene)
        : scene_(scene), denoiser_(Device::open(""), scene.shape()), follower_(scene.shape())
    {
    }

    std::vector<std::byte> operator()(std::vector<std::byte> memory, uint64_t absent = 0)
    {
        const StackView view = scene_.view(memory);
        const auto held = follower_.look(view, memory, report_, absent);
        denoiser_.denoise(view, memory, absent, {16, 1.0F}, held);
        report_ = denoiser_.report();
        if (absent == 0)
            follower_.follow(view, memory, denoiser_);
        return memory;
    }

    double moved() const { return follower_.moved(); }

private:
    Scene scene_;
    StackDenoiser denoiser_;
    SweepFollower follower_;
    DenoiseReport report_;
};

/* Part of the picture within `around` pixels of the square where luma is off by more than `most` (white is
 * 256), over all planes. */
double part_off(const Scene &scene, const std::vector<std::byte> &a, const std::vector<std::byte> &b,
                cv::Point2d square, double most, int around = 40)
{
    auto left = a, right = b;
    const auto first = pictures_of(scene.view(left), left), second = pictures_of(scene.view(right), right);
    const double unit = first[0][0].depth() == CV_16U ? 256.0 : 1.0;
    const cv::Rect near = cv::Rect(cv::Point(square) - cv::Point(around, around),
                                   cv::Size(side + 2 * around, side + 2 * around)) &
                          cv::Rect(0, 0, width, height);
    double off = 0.0, all = 0.0;
    for (unsigned z = 0; z < scene.shape().planes; z++) {
        cv::Mat difference, far;
        cv::absdiff(first[z][0](near), second[z][0](near), difference);
        cv::Mat(difference.reshape(1) > most * unit).copyTo(far);
        off += cv::countNonZero(far);
        all += static_cast<double>(far.total());
    }
    return off / all;
}

Path flight(double x, double y, double speed)
{
    return [=](double time) { return cv::Point2d(x + speed * time, y + 0.3 * speed * time); };
}

std::string name_of(const testing::TestParamInfo<PixelFormat> &info)
{
    static const char *const names[] = {"gray8", "gray16", "i420", "nv12",  "rgb",
                                        "bgr",   "rgbx",   "bgrx", "rgba64"};
    return names[static_cast<int>(info.param)];
}

class SweepFollowerFormats : public testing::TestWithParam<PixelFormat> {};

} // namespace

TEST_P(SweepFollowerFormats, what_moves_is_seen_where_it_is_in_the_middle_of_the_sweep)
{
    const Scene scene(GetParam(), 2.0);
    const Path path = flight(20, 60, 3.0);
    Follower follow(scene);
    for (unsigned t = 0; t < 8; t++) {
        const auto input = scene.sweep(t, path);
        const auto followed = follow(input);
        if (t < 6) /* where it stood at first has been seen by now */
            continue;
        const auto truth = scene.still(t, path);
        const cv::Point2d place = path(t * planes + middle);
        EXPECT_GT(part_off(scene, input, truth, place, 15), 0.08) << "sweep " << t;
        EXPECT_LT(part_off(scene, followed, truth, place, 15), 0.03) << "sweep " << t;
    }
    EXPECT_GT(follow.moved(), 0.03);
}

INSTANTIATE_TEST_SUITE_P(SweepFollower, SweepFollowerFormats,
                         testing::Values(PixelFormat::Gray8, PixelFormat::Gray16, PixelFormat::I420,
                                         PixelFormat::Nv12, PixelFormat::Rgb, PixelFormat::Bgrx,
                                         PixelFormat::Rgba64),
                         name_of);

TEST(SweepFollower, the_fewest_planes_are_followed_and_fewer_refused)
{
    const Scene scene(PixelFormat::Gray8, 2.0, SweepFollower::fewest_planes);
    const Path path = flight(20, 60, 3.0);
    Follower follow(scene);
    std::vector<std::byte> input, followed;
    for (unsigned t = 0; t < 9; t++) {
        input = scene.sweep(t, path);
        followed = follow(input);
    }
    const auto truth = scene.still(8, path);
    const cv::Point2d place = path(scene.middle_of(8));
    EXPECT_LT(part_off(scene, followed, truth, place, 15), part_off(scene, input, truth, place, 15));

    EXPECT_THROW(SweepFollower({PixelFormat::Gray8, width, height, SweepFollower::fewest_planes - 1}),
                 std::invalid_argument);
}

TEST(SweepFollower, where_nothing_moves_not_a_bit_changes)
{
    const Scene scene(PixelFormat::I420, 4.0);
    const Path rest = flight(100, 60, 0.0);
    Follower follow(scene);
    StackDenoiser alone(Device::open(""), scene.shape());
    for (unsigned t = 0; t < 8; t++) {
        auto denoised = scene.sweep(t, rest);
        alone.denoise(scene.view(denoised), denoised, 0, {16, 1.0F});
        EXPECT_EQ(follow(scene.sweep(t, rest)), denoised) << "sweep " << t;
    }
}

/* Far from it everything is as without. */
TEST(SweepFollower, what_moves_changes_nothing_elsewhere)
{
    const Scene scene(PixelFormat::Gray8, 2.0);
    const Path path = flight(20, 20, 2.0);
    Follower follow(scene);
    StackDenoiser alone(Device::open(""), scene.shape());
    for (unsigned t = 0; t < 6; t++) {
        auto denoised = scene.sweep(t, path), followed = follow(denoised);
        alone.denoise(scene.view(denoised), denoised, 0, {16, 1.0F});
        for (unsigned z = 0; z < planes; z++) {
            const size_t rows = (z + 1) * size_t{height} * width;
            EXPECT_TRUE(std::equal(followed.begin() + static_cast<std::ptrdiff_t>(rows - size_t{40} * width),
                                   followed.begin() + static_cast<std::ptrdiff_t>(rows),
                                   denoised.begin() + static_cast<std::ptrdiff_t>(rows - size_t{40} * width)))
                << "plane " << z << " of sweep " << t;
        }
    }
}

TEST(SweepFollower, what_stops_is_seen_where_it_stopped)
{
    const Scene scene(PixelFormat::Gray8, 2.0);
    const Path path = [](double time) { return cv::Point2d(40 + 3 * std::min(time, 4.0 * planes), 80); };
    Follower follow(scene);
    for (unsigned t = 0; t < 10; t++) {
        const auto followed = follow(scene.sweep(t, path));
        if (t < 5)
            continue;
        EXPECT_LT(part_off(scene, followed, scene.still(t, path), path(t * planes), 15), 0.02)
            << "sweep " << t;
    }
    EXPECT_EQ(follow.moved(), 0.0);
}

TEST(SweepFollower, what_begins_to_move_leaves_hardly_a_ghost)
{
    const Scene scene(PixelFormat::Gray8, 2.0);
    const Path path = [](double time) {
        return cv::Point2d(40 + 3 * std::max(time - 4.0 * planes, 0.0), 80);
    };
    Follower follow(scene);
    for (unsigned t = 0; t < 10; t++) {
        const auto input = scene.sweep(t, path), followed = follow(input);
        const auto truth = scene.still(t, path);
        const cv::Point2d start = path(0);
        if (t < 4)
            continue;
        EXPECT_LE(part_off(scene, followed, truth, start, 25, 0),
                  std::max(0.04, part_off(scene, input, truth, start, 25, 0)))
            << "sweep " << t;
    }
}

/* It is not followed, and what is behind the object is remembered through it. */
TEST(SweepFollower, the_sweep_after_one_with_lost_planes_is_as_without_them)
{
    const Scene scene(PixelFormat::I420, 3.0);
    const Path path = flight(20, 60, 4);
    const auto layout = packed_layout(scene.shape());
    double off[2] = {};
    for (const bool is_lost : {false, true}) {
        Follower follower(scene);
        for (unsigned sweep = 0; sweep < 6; sweep++) {
            std::vector<std::byte> memory = scene.sweep(sweep, path);
            const bool lacks = is_lost && sweep == 4;
            if (lacks) /* plane 2 shows nothing */
                std::fill_n(memory.begin() + static_cast<std::ptrdiff_t>(layout[2].offset),
                            layout[2].stride * height, std::byte{0});
            memory = follower(std::move(memory), lacks ? 4 : 0);
            if (sweep == 5)
                off[is_lost ? 1 : 0] =
                    part_off(scene, memory, scene.still(sweep, path), path(scene.middle_of(sweep)), 20);
        }
    }
    EXPECT_LT(off[0], 0.03);
    EXPECT_LT(off[1], off[0] + 0.01);
}

TEST(SweepFollower, a_cut_shows_the_new_scene_alone)
{
    const Scene scene(PixelFormat::Rgb, 2.0);
    const Path rest = flight(100, 60, 0.0);
    Follower follow(scene);
    for (unsigned t = 0; t < 4; t++)
        follow(scene.sweep(t, rest));
    auto cut = scene.sweep(5, rest);
    std::transform(cut.begin(), cut.end(), cut.begin(),
                   [](std::byte value) { return static_cast<std::byte>(255 - static_cast<int>(value)); });
    EXPECT_EQ(follow(cut), cut);
}
