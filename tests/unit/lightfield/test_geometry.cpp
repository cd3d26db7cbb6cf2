/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_geometry.h"
#include "lightfield/display_preset.h"
#include "lightfield/light_field_settings.h"
#include "lightfield/sweep_positions.h"

#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

using namespace dff;

TEST(Geometry, views_are_those_of_cameras_with_asymmetric_frusta)
{
    /* OpenGL's camera, which looks through a window of half-width 1 in the plane of zero parallax from
     * `distance`. */
    const double distance = 2.2, near = 0.01;
    for (unsigned view = 0; view < 5; view++) {
        const double slope = view_slope(view, 5, 0.7), eye = slope * distance;
        const double k = near / distance;
        const glm::dmat4 camera = glm::frustum(k * (-1.0 - eye), k * (1.0 - eye), -k, k, near, 100.0) *
                                  glm::translate(glm::dmat4(1.0), glm::dvec3(-eye, 0.0, -distance));
        const glm::dmat4 middle = glm::frustum(-k, k, -k, k, near, 100.0) *
                                  glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -distance));
        for (const glm::dvec3 point :
             {glm::dvec3(0.3, 0.1, 0.8), glm::dvec3(-0.9, 0.2, -5.0), glm::dvec3(0.5, 0.0, 0.0)}) {
            const glm::dvec4 seen = camera * glm::dvec4(point, 1.0),
                             from_middle = middle * glm::dvec4(point, 1.0);
            /* The vergence of the point less that of the plane, as heights are linear in it. */
            const double height = distance * (distance / (distance - point.z) - 1.0);
            EXPECT_NEAR(seen.x / seen.w, from_middle.x / from_middle.w - slope * height, 1e-12);
            EXPECT_NEAR(seen.y / seen.w, from_middle.y / from_middle.w, 1e-12);
        }
    }
}

TEST(Geometry, the_first_view_looks_from_the_left)
{
    EXPECT_NEAR(view_slope(0, 48, 0.8), -std::tan(0.4), 1e-12);
    EXPECT_NEAR(view_slope(47, 48, 0.8), std::tan(0.4), 1e-12);
    EXPECT_EQ(view_slope(0, 1, 0.8), 0.0);
}

TEST(Geometry, layers_are_never_larger_than_the_picture_nor_than_the_views)
{
    LightFieldParameters parameters;
    parameters.view_aspect = 0.75;
    const LightFieldGeometry quilt(parameters, {1920, 1080}, {3360, 3360});
    EXPECT_EQ(quilt.view, glm::ivec2(420, 560));
    EXPECT_EQ(quilt.layers, glm::ivec2(996, 560));
    EXPECT_NEAR(quilt.range, 0.15 * 420, 0.2);
    parameters.columns = parameters.rows = 1;
    const LightFieldGeometry enlarged(parameters, {320, 240}, {3000, 4000});
    EXPECT_EQ(enlarged.layers, glm::ivec2(320, 240));
    /* The middle of the picture is the middle of the view. */
    EXPECT_NEAR(enlarged.start({1499.5, 1999.5}).x, 159.5, 1e-9);
    EXPECT_NEAR(enlarged.start({1499.5, 1999.5}).y, 119.5, 1e-9);
}

TEST(Geometry, a_lens_without_a_gap_fans_out_over_the_view_cone)
{
    LightFieldParameters parameters;
    parameters.lenses.pitch = 12.0;
    EXPECT_NEAR(2.0 * std::atan(6.0 / lens_gap(parameters)), parameters.view_cone, 1e-12);
}

TEST(Geometry, colours_lie_where_their_cell_says)
{
    const PictureSize panel{200, 100};
    LenticularSheet sheet;
    sheet.tilt = -0.5;
    EXPECT_NEAR(subpixel_shift(sheet, {3, 5}, 2, panel), 2.0 / 600.0, 1e-15);
    sheet.flip_subpixels = true;
    EXPECT_NEAR(subpixel_shift(sheet, {3, 5}, 2, panel), 0.0, 1e-15);
    for (int cell = 0; cell < 4; cell++)
        sheet.cells.push_back({{{0.01 * cell, 0.2}, {0.1, 0.0}, {0.2, 0.0}}});
    const auto cell_at = [&](CellPattern pattern, int x, int y) {
        sheet.pattern = pattern;
        return std::lround((subpixel_shift(sheet, {x, y}, 0, panel) + 0.5 * 0.2 / 100.0) * 200.0 / 0.01);
    };
    EXPECT_EQ(cell_at(CellPattern::Single, 1, 1), 0);
    EXPECT_EQ(cell_at(CellPattern::Checkerboard, 1, 1), 0);
    EXPECT_EQ(cell_at(CellPattern::Checkerboard, 1, 2), 1);
    EXPECT_EQ(cell_at(CellPattern::Rows, 1, 7), 3);
    EXPECT_EQ(cell_at(CellPattern::ShiftedRows, 1, 7), 1);
    EXPECT_EQ(cell_at(CellPattern::Columns, 5, 3), 1);
    sheet.cells.resize(2);
    EXPECT_EQ(cell_at(CellPattern::Rows, 1, 7), 1) << "fewer cells are counted over again";
}

TEST(Presets, are_as_the_maker_asks)
{
    ASSERT_EQ(display_presets().size(), 7u);
    const DisplayPreset &portrait = display_presets()[1];
    EXPECT_STREQ(portrait.nick, "looking-glass-portrait");
    EXPECT_EQ(quilt_suffix(portrait.columns, portrait.rows, portrait.aspect), "_qs8x6a0.75");
    EXPECT_EQ(quilt_suffix(7, 7, 16.0 / 9.0), "_qs7x7a1.7778");
}

TEST(Settings, a_quilt_fits_what_decoders_take_and_what_the_picture_holds)
{
    LightFieldSettings settings;
    const PictureSize large = LightFieldPlan(settings, {3840, 2160}).output;
    EXPECT_LE(large.width, 4096u);
    EXPECT_LE(large.height, 4096u);
    const PictureSize small = LightFieldPlan(settings, {64, 48}).output;
    EXPECT_EQ(small, (PictureSize{8 * 64, 6 * 48}));
}

TEST(SweepPositions, are_linear_in_dioptres_in_every_unit)
{
    const SweepPlan plan = SweepPlan::even(6, 5.0, 1.0);
    for (const DepthEncoder &encoder :
         {DepthEncoder::index(6), DepthEncoder::dioptre(plan), DepthEncoder::millimetre(plan),
          DepthEncoder::micrometre({0.0, 10.0, 20.0, 30.0, 40.0, 50.0})}) {
        const std::vector<float> positions = sweep_positions({encoder.scale(), 5.0, 1.0});
        for (double z = 0.0; z <= 5.0; z += 0.25)
            EXPECT_NEAR(positions[encoder.encode(z)], z / 5.0, 0.003)
                << static_cast<int>(encoder.scale().unit);
        EXPECT_TRUE(std::isnan(positions[0]));
    }
}

TEST(SweepPositions, do_without_what_is_not_known)
{
    const std::vector<float> millimetres = sweep_positions({{DepthUnit::Millimetre, 0.0, 0.0}, 0.0, 0.0});
    EXPECT_EQ(millimetres[400], 0.0F);
    EXPECT_NEAR(millimetres[1000], 0.5F, 1e-6F);
    const std::vector<float> dioptres = sweep_positions({{DepthUnit::Dioptre, 0.0, 0.0}, 0.0, 0.0});
    EXPECT_EQ(dioptres[1], 0.0F);
    EXPECT_EQ(dioptres[65535], 1.0F);
    EXPECT_FALSE(sweep_position({}, 2.0).has_value());
    EXPECT_NEAR(*sweep_position({{DepthUnit::Index, 0.0, 0.0}, 5.0, 1.0}, 3.0), 0.5, 1e-12);
}
