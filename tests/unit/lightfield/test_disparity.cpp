/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_renderer.h"
#include "lightfield/light_field_disparity.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

using namespace dff;

namespace {

constexpr PictureSize picture{200, 16};
constexpr double cone = 30.0 * std::numbers::pi / 180.0;

LightFieldParameters views(unsigned count, double gain, double zero_parallax)
{
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Views;
    parameters.columns = count;
    parameters.rows = 1;
    parameters.view_cone = cone;
    parameters.depth_gain = gain;
    parameters.zero_parallax = zero_parallax;
    return parameters;
}

/* A soft line at an end of the sweep, rendered: how far it moves from the first view to the last. */
double seen_disparity(const LightFieldParameters &parameters, uint16_t depth)
{
    const PictureSize output{picture.width * parameters.columns, picture.height};
    std::vector<uint8_t> color(size_t{3} * picture.width * picture.height),
        result(color.size() * parameters.columns);
    for (size_t i = 0; i < color.size(); i++)
        color[i] =
            static_cast<uint8_t>(255.0 * std::exp(-std::pow((i / 3 % picture.width - 100.0) / 4.0, 2.0)));
    const std::vector<uint16_t> depths(size_t{picture.width} * picture.height, depth);
    LightFieldRenderer renderer(Device::open(""), {PixelFormat::Rgb, picture, output}, parameters);
    renderer.render({std::as_bytes(std::span(color)), 3 * size_t{picture.width}},
                    {std::as_bytes(std::span(depths)), 2 * size_t{picture.width}},
                    std::as_writable_bytes(std::span(result)), 3 * size_t{output.width});
    const auto middle_of = [&](unsigned view) {
        double sum = 0.0, moment = 0.0;
        for (unsigned x = 0; x < picture.width; x++) {
            const double light = result[size_t{3} * (output.width * 8 + view * picture.width + x)];
            sum += light, moment += light * x;
        }
        return moment / sum;
    };
    return std::abs(middle_of(parameters.columns - 1) - middle_of(0));
}

} // namespace

TEST(Disparity, is_that_of_the_end_which_moves_most)
{
    const uint16_t near = 1, far = 65535;
    for (const auto &[zero_parallax, end] : {std::pair{0.2, far}, std::pair{0.7, near}}) {
        const LightFieldParameters parameters = views(5, 0.1, zero_parallax);
        const LightFieldDisparity disparity(parameters, {5 * picture.width, picture.height});
        EXPECT_NEAR(disparity.outermost, seen_disparity(parameters, end), 0.1) << zero_parallax;
        EXPECT_GT(disparity.outermost, seen_disparity(parameters, near + far - end)) << zero_parallax;
    }
}

TEST(Disparity, of_views_is_sharp_up_to_a_pixel_from_view_to_view)
{
    const unsigned count = 9;
    const LightFieldDisparity disparity(views(count, 0.1, 0.5), {count * picture.width, picture.height});
    const LightFieldDisparity at_most(views(count, disparity.sharp_gain, 0.5),
                                      {count * picture.width, picture.height});
    EXPECT_NEAR(at_most.outermost, at_most.sharp, 1e-9);
    EXPECT_NEAR(at_most.sharp, disparity.sharp, 1e-9);
    const double height = disparity.sharp_gain * picture.width * 0.5;
    double most = 0.0;
    for (unsigned view = 1; view < count; view++)
        most = std::max(most, height * (view_slope(view, count, cone) - view_slope(view - 1, count, cone)));
    EXPECT_NEAR(most, 1.0, 1e-9);
}

TEST(Disparity, two_views_are_for_an_eye_each_and_always_sharp)
{
    EXPECT_TRUE(LightFieldDisparity(views(2, 10.0, 0.0), {2 * picture.width, picture.height}).is_sharp());
    EXPECT_EQ(LightFieldDisparity(views(1, 10.0, 0.0), picture), LightFieldDisparity());
}

TEST(Disparity, of_round_lenses_is_sharp_up_to_a_lens_from_pixel_to_pixel)
{
    LightFieldParameters parameters = views(1, 0.3, 0.5);
    parameters.layout = LightFieldLayout::Elemental;
    parameters.lenses.pitch = 15.5;
    parameters.lenses.gap = 30.0;
    const LightFieldDisparity disparity(parameters, {1920, 1080});
    const double height = 0.3 * 1920 / 2; /* pixels before the panel; a ray leans by 1 / gap a pixel */
    EXPECT_NEAR(disparity.outermost, height * 15.5 / 30.0, 1e-9);
    EXPECT_NEAR(disparity.sharp, 15.5 * 15.5, 1e-9);
    EXPECT_NEAR(disparity.sharp_gain, 0.3 * 15.5 * 30.0 / height, 1e-9);
}

TEST(Disparity, of_cylinders_is_sharp_up_to_a_lens_from_subpixel_to_subpixel)
{
    LightFieldParameters parameters = views(1, 0.3, 0.5);
    parameters.layout = LightFieldLayout::Lenticular;
    parameters.sheet.pitch = 256.0; /* lenses of six pixels */
    const LightFieldDisparity disparity(parameters, {1536, 2048});
    EXPECT_NEAR(disparity.outermost, 0.3 * 1536 * std::tan(cone / 2.0), 1e-9);
    EXPECT_NEAR(disparity.sharp, 3 * 6 * 6, 1e-9);
}
