/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_renderer.h"
#include "optics/depth_scale.h"
#include "twin.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>
#include <random>

using namespace dff;

namespace {

/* Things of several depths before a ground, coloured at random, with holes in the depth map. */
struct Picture {
    explicit Picture(PictureSize size)
        : size(size), color(size_t{size.width} * size.height * 3), depth(color.size() / 3)
    {
        std::mt19937 random(7);
        for (uint8_t &value : color)
            value = static_cast<uint8_t>(random() % 256);
        for (uint32_t y = 0; y < size.height; y++)
            for (uint32_t x = 0; x < size.width; x++) {
                double u = 0.9 - 0.1 * y / size.height;
                if (x > size.width / 4 && x < size.width / 2)
                    u = 0.3 + 0.002 * x;
                if (x > size.width * 3 / 8 && x < size.width * 5 / 8 && y > size.height / 2)
                    u = 0.05;
                depth[y * size.width + x] =
                    random() % 50 == 0 ? 0 : static_cast<uint16_t>(1 + std::lround(65534 * u));
            }
    }

    std::vector<glm::dvec3> colors() const
    {
        std::vector<glm::dvec3> result;
        for (size_t i = 0; i < depth.size(); i++)
            result.emplace_back(color[3 * i], color[3 * i + 1], color[3 * i + 2]);
        return result;
    }

    std::vector<float> positions() const
    {
        std::vector<float> result;
        for (const uint16_t pixel : depth)
            result.push_back(pixel ? static_cast<float>(pixel - 1) / 65534.0F : NAN);
        return result;
    }

    PictureSize size;
    std::vector<uint8_t> color;
    std::vector<uint16_t> depth;
};

/* The default device, whatever it is, with kernels of one style. */
std::shared_ptr<Device> device_with(KernelStyle style)
{
    return std::make_shared<Device>(Device::open("")->device(), style);
}

std::vector<uint8_t> render(const Picture &picture, PictureSize output,
                            const LightFieldParameters &parameters, KernelStyle style = KernelStyle::Tiles)
{
    LightFieldRenderer renderer(device_with(style), {PixelFormat::Rgb, picture.size, output}, parameters);
    std::vector<uint8_t> result(size_t{output.width} * output.height * 3);
    renderer.render({std::as_bytes(std::span(picture.color)), 3 * size_t{picture.size.width}},
                    {std::as_bytes(std::span(picture.depth)), 2 * size_t{picture.size.width}},
                    std::as_writable_bytes(std::span(result)), 3 * size_t{output.width});
    return result;
}

/* The share of samples that differ by more than rounding: rays that just touch an edge may fall on either
 * side. */
template <typename Ray>
double share_that_differs(const Picture &picture, PictureSize output, const LightFieldParameters &parameters,
                          Ray ray, KernelStyle style = KernelStyle::Tiles)
{
    const std::vector<uint8_t> found = render(picture, output, parameters, style);
    const LightFieldGeometry geometry(parameters, picture.size, output);
    const TwinLayers twin(geometry, picture.size, picture.colors(), picture.positions());
    size_t different = 0;
    for (uint32_t y = 0; y < output.height; y++)
        for (uint32_t x = 0; x < output.width; x++)
            for (int c = 0; c < 3; c++) {
                const auto [origin, slope] = ray(geometry, glm::dvec2(x, y), c);
                const double expected = twin.trace(origin, slope, parameters.fill)[c];
                different += std::abs(found[(y * output.width + x) * 3 + c] - expected) > 1.5;
            }
    return static_cast<double>(different) / (3.0 * output.width * output.height);
}

struct Ray {
    glm::dvec2 origin, slope;
};

} // namespace

TEST(Renderer, a_quilt_agrees_with_its_twin)
{
    const Picture picture({90, 60});
    LightFieldParameters parameters;
    parameters.columns = 3;
    parameters.rows = 2;
    parameters.depth_gain = 0.4;
    const auto ray = [](const LightFieldGeometry &geometry, glm::dvec2 pixel, int) {
        const glm::ivec2 tile = glm::ivec2(pixel) / glm::ivec2(90, 60);
        const unsigned view = static_cast<unsigned>((1 - tile.y) * 3 + tile.x);
        return Ray{geometry.start(pixel - glm::dvec2(tile * glm::ivec2(90, 60))),
                   {std::tan((view / 5.0 - 0.5) * 40.0 / 180.0 * M_PI), 0.0}};
    };
    for (const KernelStyle style : {KernelStyle::Pixels, KernelStyle::Tiles})
        for (const bool fill : {true, false}) {
            parameters.fill = fill;
            EXPECT_LT(share_that_differs(picture, {3 * 90, 2 * 60}, parameters, ray, style), 2e-3)
                << "fill " << fill << " tiles " << (style == KernelStyle::Tiles);
        }
}

TEST(Renderer, a_lenticular_panel_agrees_with_its_twin)
{
    const Picture picture({90, 60});
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Lenticular;
    parameters.sheet = {13.7, -0.21, 0.3, true, true, false, true};
    const double share = share_that_differs(
        picture, {120, 80}, parameters, [&](const LightFieldGeometry &geometry, glm::dvec2 pixel, int c) {
            const double x = (pixel.x + 0.5) / 120 + (2 - c) / 360.0, y = 1.0 - (pixel.y + 0.5) / 80;
            const double place = (x - 0.21 * y) * 13.7 - 0.3;
            const double view = 1.0 - (place - std::floor(place));
            return Ray{geometry.start({119.0 - pixel.x, pixel.y}),
                       {std::tan((view - 0.5) * parameters.view_cone), 0.0}};
        });
    EXPECT_LT(share, 4e-3);
}

TEST(Renderer, elemental_images_agree_with_their_twin)
{
    const Picture picture({90, 60});
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Elemental;
    parameters.lenses.pitch = 7.3;
    parameters.lenses.gap = 9.1;
    parameters.lenses.rotation = 0.3;
    parameters.lenses.center = {1.5, -2.25};
    for (const LensGrid grid : {LensGrid::Square, LensGrid::Hexagonal})
        for (const bool flip : {false, true}) {
            parameters.lenses.grid = grid;
            parameters.lenses.flip = flip;
            /* The nearest of all lenses, each placed by hand. */
            std::vector<glm::dvec2> lenses;
            for (int row = -14; row <= 14; row++)
                for (int column = -14; column <= 14; column++) {
                    const bool hex = grid == LensGrid::Hexagonal;
                    const glm::dvec2 p(7.3 * (column + (hex && row % 2 != 0 ? 0.5 : 0.0)),
                                       7.3 * row * (hex ? std::sqrt(0.75) : 1.0));
                    lenses.emplace_back(61.5 + std::cos(0.3) * p.x - std::sin(0.3) * p.y,
                                        37.75 + std::sin(0.3) * p.x + std::cos(0.3) * p.y);
                }
            const double share = share_that_differs(
                picture, {120, 80}, parameters,
                [&](const LightFieldGeometry &geometry, glm::dvec2 pixel, int) {
                    const glm::dvec2 p = pixel + 0.5;
                    const auto distance = [&](glm::dvec2 lens) { return glm::dot(lens - p, lens - p); };
                    const glm::dvec2 c =
                        *std::min_element(lenses.begin(), lenses.end(), [&](glm::dvec2 a, glm::dvec2 b) {
                            return distance(a) < distance(b);
                        });
                    return Ray{geometry.start(c - 0.5), (flip ? p - c : c - p) / 9.1};
                });
            EXPECT_LT(share, 4e-3) << "hex " << (grid == LensGrid::Hexagonal) << " flip " << flip;
        }
}

TEST(Renderer, rgbd_is_colour_and_depth_and_near_is_white)
{
    const Picture picture({90, 60});
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Rgbd;
    for (const bool invert : {false, true}) {
        parameters.invert_depth = invert;
        const std::vector<uint8_t> found = render(picture, {180, 60}, parameters);
        for (uint32_t y = 0; y < 60; y++)
            for (uint32_t x = 0; x < 90; x++) {
                ASSERT_EQ(found[(y * 180 + x) * 3 + 1], picture.color[(y * 90 + x) * 3 + 1]);
                const uint16_t pixel = picture.depth[y * 90 + x];
                const double nearness = pixel ? 1.0 - (pixel - 1) / 65534.0 : 0.0;
                ASSERT_NEAR(found[(y * 180 + 90 + x) * 3], 255.0 * (invert ? 1.0 - nearness : nearness), 0.6);
            }
    }
}

TEST(Renderer, depth_is_on_any_side_of_its_colour)
{
    const Picture picture({30, 20});
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Rgbd;
    const std::vector<uint8_t> right = render(picture, {60, 20}, parameters);
    struct Case {
        DepthSide side;
        PictureSize output;
        unsigned color_x, color_y, depth_x, depth_y;
    };
    for (const Case &c :
         {Case{DepthSide::Left, {60, 20}, 30, 0, 0, 0}, Case{DepthSide::Below, {30, 40}, 0, 0, 0, 20},
          Case{DepthSide::Above, {30, 40}, 0, 20, 0, 0}}) {
        parameters.depth_side = c.side;
        const std::vector<uint8_t> found = render(picture, c.output, parameters);
        const auto at = [&](unsigned x, unsigned y) { return found[(y * c.output.width + x) * 3 + 1]; };
        for (unsigned y = 0; y < 20; y++)
            for (unsigned x = 0; x < 30; x++) {
                ASSERT_EQ(at(c.color_x + x, c.color_y + y), right[(y * 60 + x) * 3 + 1]);
                ASSERT_EQ(at(c.depth_x + x, c.depth_y + y), right[(y * 60 + 30 + x) * 3 + 1]);
            }
    }
}

TEST(Renderer, views_below_each_other_are_those_beside_each_other)
{
    const Picture picture({30, 20});
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Views;
    parameters.columns = 2;
    parameters.rows = 1;
    const std::vector<uint8_t> beside = render(picture, {60, 20}, parameters);
    std::swap(parameters.columns, parameters.rows);
    for (const KernelStyle style : {KernelStyle::Pixels, KernelStyle::Tiles}) {
        const std::vector<uint8_t> below = render(picture, {30, 40}, parameters, style);
        size_t different = 0;
        for (unsigned view = 0; view < 2; view++)
            for (unsigned y = 0; y < 20; y++)
                for (unsigned i = 0; i < 90; i++)
                    different +=
                        std::abs(below[(view * 20 + y) * 90 + i] - beside[y * 180 + view * 90 + i]) > 2;
        EXPECT_LE(different, 4U) << "the left eye's view is on top";
    }
}

TEST(Renderer, both_kinds_of_kernels_show_the_same_when_views_are_small)
{
    const Picture picture({150, 100});
    LightFieldParameters quilt;
    quilt.columns = 4;
    quilt.rows = 3;
    quilt.view_aspect = 0.6; /* crops the picture, and shrinks what is left */
    LightFieldParameters panel;
    panel.layout = LightFieldLayout::Lenticular;
    panel.sheet = {11.3, 0.17, 0.1, false, false, true, false};
    LightFieldParameters cells = panel;
    cells.sheet.cells = {{{{-0.25, -0.3}, {-0.25, 0.3}, {0.25, 0.0}}},
                         {{{0.25, -0.3}, {0.25, 0.3}, {-0.25, 0.0}}}};
    cells.sheet.pattern = CellPattern::Checkerboard;
    LightFieldParameters array;
    array.layout = LightFieldLayout::Elemental;
    array.lenses.pitch = 6.3;
    array.lenses.grid = LensGrid::Hexagonal;
    for (const LightFieldParameters &parameters : {quilt, panel, cells, array}) {
        const PictureSize output{4 * 37, 3 * 61};
        const std::vector<uint8_t> by_pixels = render(picture, output, parameters, KernelStyle::Pixels);
        const std::vector<uint8_t> by_rows = render(picture, output, parameters, KernelStyle::Tiles);
        size_t different = 0;
        for (size_t i = 0; i < by_rows.size(); i++)
            different += std::abs(by_rows[i] - by_pixels[i]) > 2;
        EXPECT_LT(static_cast<double>(different) / static_cast<double>(by_rows.size()), 4e-3);
    }
}

TEST(Renderer, the_same_point_looks_the_same_in_every_view)
{
    /* A flat picture at the near end: each view shows it shifted by a whole number of pixels. */
    Picture picture({120, 20});
    std::fill(picture.depth.begin(), picture.depth.end(), uint16_t{1});
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Views;
    parameters.columns = 3;
    parameters.rows = 1;
    parameters.zero_parallax = 1.0;
    parameters.depth_gain = 0.1; /* 12 pixels high */
    parameters.view_cone = 2.0 * std::atan(0.5);
    const std::vector<uint8_t> views = render(picture, {360, 20}, parameters);
    for (unsigned x = 10; x < 110; x++)
        for (const int view : {0, 1, 2})
            EXPECT_EQ(views[(5 * 360 + view * 120 + x + 6 - 6 * view) * 3], picture.color[(5 * 120 + x) * 3])
                << "from the right, near things stand farther left";
}

TEST(Renderer, near_things_hide_far_ones_and_holes_show_the_background)
{
    /* A red thing before a blue ground. */
    Picture picture({100, 4});
    for (size_t i = 0; i < picture.depth.size(); i++) {
        const bool thing = i % 100 >= 40 && i % 100 < 60;
        picture.depth[i] = thing ? 1 : 65535;
        picture.color[3 * i] = thing ? 255 : 0;
        picture.color[3 * i + 1] = 0;
        picture.color[3 * i + 2] = thing ? 0 : 255;
    }
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Views;
    parameters.columns = 2;
    parameters.rows = 1;
    parameters.depth_gain = 0.2;
    parameters.view_cone = 2.0 * std::atan(0.5); /* the thing moves by 5, the ground by -5 */
    for (const auto &[fill, style] : {std::pair(true, KernelStyle::Tiles),
                                      {false, KernelStyle::Tiles},
                                      {true, KernelStyle::Pixels},
                                      {false, KernelStyle::Pixels}}) {
        parameters.fill = fill;
        const std::vector<uint8_t> views = render(picture, {200, 4}, parameters, style);
        for (unsigned x = 0; x < 100; x++) {
            const uint8_t *left = &views[(200 + x) * 3], *right = &views[(200 + 100 + x) * 3];
            EXPECT_EQ(left[0] == 255, x >= 45 && x < 65) << x;
            EXPECT_EQ(right[0] == 255, x >= 35 && x < 55) << x;
            const bool hole = x >= 35 && x < 45; /* to the left of the thing */
            EXPECT_EQ(left[2] == 255, !(x >= 45 && x < 65) && (fill || !hole)) << x;
        }
    }
}

TEST(Renderer, depth_of_zero_takes_the_farther_neighbour)
{
    Picture picture({60, 2});
    for (size_t i = 0; i < picture.depth.size(); i++)
        picture.depth[i] = i % 60 < 20 ? 1 : i % 60 < 30 ? 0 : 40000;
    Picture filled = picture;
    std::replace(filled.depth.begin(), filled.depth.end(), uint16_t{0}, uint16_t{40000});
    LightFieldParameters parameters;
    parameters.columns = parameters.rows = 2;
    EXPECT_EQ(render(picture, {120, 4}, parameters), render(filled, {120, 4}, parameters));
}

TEST(Renderer, what_is_left_over_of_a_quilt_is_black)
{
    Picture picture({60, 20});
    std::fill(picture.color.begin(), picture.color.end(), uint8_t{200});
    LightFieldParameters parameters;
    parameters.columns = 7;
    parameters.rows = 3;
    for (const KernelStyle style : {KernelStyle::Pixels, KernelStyle::Tiles}) {
        const std::vector<uint8_t> quilt = render(picture, {75, 32}, parameters, style);
        for (size_t y = 0; y < 32; y++)
            for (size_t x = 0; x < 75; x++)
                ASSERT_EQ(quilt[(y * 75 + x) * 3], x < 70 && y >= 2 ? 200 : 0) << x << "," << y;
    }
}

TEST(Renderer, without_any_depth_all_views_are_the_picture)
{
    Picture picture({60, 20});
    std::fill(picture.depth.begin(), picture.depth.end(), uint16_t{0});
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Views;
    parameters.columns = 2;
    parameters.rows = 1;
    const std::vector<uint8_t> views = render(picture, {120, 20}, parameters);
    for (size_t i = 0; i < picture.color.size(); i++)
        EXPECT_EQ(views[i / 180 * 360 + i % 180], picture.color[i]);
}
