/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lightfield/display_calibration.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <stdexcept>
#include <unistd.h>

using dff::DisplayCalibration;

namespace {

std::string write(const std::string &ending, const std::string &text)
{
    std::string path = testing::TempDir() + "calibration." + std::to_string(getpid()) + "." + ending;
    std::ofstream(path) << text;
    return path;
}

std::string refusal_of(const std::string &path)
{
    try {
        DisplayCalibration::load(path);
    } catch (const std::runtime_error &error) {
        return error.what();
    }
    return "";
}

/* As a display tells it. */
const std::string display =
    R"({"configVersion":"3.0","serial":"LKG-0","pitch":{"value":52.5},"slope":{"value":-7.2},"center":{"value":0.25},)"
    R"("viewCone":{"value":35.0},"invView":{"value":1.0},"verticalAngle":{"value":0.0},"DPI":{"value":324.0},)"
    R"("screenW":{"value":1536.0},"screenH":{"value":2048.0},"flipImageX":{"value":0.0},"flipImageY":{"value":0.0},)"
    R"("flipSubp":{"value":0.0}})";

} // namespace

TEST(Calibration, reads_what_displays_tell_of_themselves)
{
    const DisplayCalibration calibration = DisplayCalibration::load(write("json", display));
    EXPECT_EQ(calibration.panel, (dff::PictureSize{1536, 2048}));
    EXPECT_NEAR(calibration.view_cone, 35.0 / 180.0 * M_PI, 1e-12);
    EXPECT_NEAR(calibration.sheet.pitch, 52.5 * 1536 / 324 * std::cos(std::atan(1 / -7.2)), 1e-9);
    EXPECT_NEAR(calibration.sheet.tilt, 2048.0 / (1536 * -7.2), 1e-12);
    EXPECT_EQ(calibration.sheet.center, 0.25);
    EXPECT_TRUE(calibration.sheet.invert_view);
    EXPECT_FALSE(calibration.sheet.flip_x);
}

TEST(Calibration, reads_yaml_with_plain_numbers)
{
    const DisplayCalibration calibration = DisplayCalibration::load(
        write("yaml", "%YAML:1.0\n---\npitch: 52.5\nslope: -7.2\ncenter: 0.25\nDPI: 324\nscreenW: 1536\n"
                      "screenH: 2048\nflipImageX: 1\nflipSubp: 1\n"));
    EXPECT_NEAR(calibration.sheet.tilt, 2048.0 / (1536 * 7.2), 1e-12) << "the lenses lean the other way";
    EXPECT_TRUE(calibration.sheet.flip_x);
    EXPECT_TRUE(calibration.sheet.flip_subpixels);
    EXPECT_EQ(calibration.view_cone, 0.0);
}

TEST(Calibration, reads_where_the_colours_of_newer_panels_are)
{
    const std::string cells =
        R"(,"CellPatternMode":{"value":4.0},"subpixelCells":[{"ROffsetX":-0.25,"ROffsetY":-0.31,"GOffsetX":-0.25,)"
        R"("GOffsetY":0.28,"BOffsetX":0.25,"BOffsetY":0.0},{"ROffsetX":0.25,"ROffsetY":-0.31,"GOffsetX":0.25,)"
        R"("GOffsetY":0.28,"BOffsetX":-0.25,"BOffsetY":0.0}]})";
    const std::string before = display.substr(0, display.size() - 1);
    const DisplayCalibration calibration = DisplayCalibration::load(write("json", before + cells));
    ASSERT_EQ(calibration.sheet.cells.size(), 2U);
    EXPECT_EQ(calibration.sheet.pattern, dff::CellPattern::Columns);
    EXPECT_EQ(calibration.sheet.cells[1][0], (glm::dvec2(0.25, -0.31)));
    EXPECT_EQ(calibration.sheet.cells[0][2], (glm::dvec2(0.25, 0.0)));

    const std::string none = before + R"(,"subpixelCells":[],"CellPatternMode":{"value":0}})";
    EXPECT_TRUE(DisplayCalibration::load(write("json", none)).sheet.cells.empty());
    const std::string cut = before + R"(,"subpixelCells":[{"ROffsetX":0.1}]})";
    EXPECT_NE(refusal_of(write("json", cut)).find("subpixelCells[0].ROffsetY is missing"), std::string::npos)
        << refusal_of(write("json", cut));
}

TEST(Calibration, says_what_is_wrong_with_a_file)
{
    EXPECT_NE(refusal_of("/nonexistent.json").find("/nonexistent.json"), std::string::npos);
    EXPECT_NE(refusal_of(write("json", "{\"pitch\": 5,")).find("neither YAML"), std::string::npos);
    EXPECT_NE(refusal_of(write("json", "")).find("display calibration"), std::string::npos);
    EXPECT_NE(refusal_of(write("json", "{\"screenW\": 1536, \"screenH\": 2048}")).find("slope is missing"),
              std::string::npos);
    EXPECT_NE(refusal_of(write("json", "[1, 2]")), "");
}

TEST(Calibration, what_no_display_has_is_refused_with_the_range)
{
    struct Case {
        const char *from, *to, *reason;
    };
    for (const auto &[from, to, reason] : {
             Case{"1536.0", "0.5", "screenW.value is 0.5 and must be 1 to 16384"},
             Case{"1536.0", "0", "screenW.value is 0 and must be 1 to 16384"},
             Case{"2048.0", "32768", "screenH.value is 32768 and must be 1 to 16384"},
             Case{"2048.0", "\"high\"", "screenH.value is not a number"},
             Case{"-7.2", "0", "slope is nearly 0"},
             Case{"-7.2", "1e-300", "slope is nearly 0"},
             Case{"-7.2", "1e300", "slope.value is 1e+300 and must be"},
             Case{"52.5", "1e300", "pitch.value is 1e+300 and must be 0.01 to 10000"},
             Case{"52.5", "0", "pitch.value is 0 and must be 0.01 to 10000"},
             Case{"52.5", "5000", "a lens is narrower than a subpixel"},
             Case{"324.0", "1e-300", "DPI.value is 1e-300 and must be 1 to 10000"},
             Case{"0.25", "1e300", "center.value is 1e+300 and must be"},
             Case{"35.0", "180", "viewCone.value is 180 and must be 0 to 120"},
             Case{R"("flipSubp":{"value":0.0})", R"("flipSubp":7)", "flipSubp is 7 and must be 0 to 1"},
         }) {
        std::string text = display;
        const std::string fault =
            refusal_of(write("json", text.replace(text.find(from), std::string(from).size(), to)));
        EXPECT_NE(fault.find(reason), std::string::npos) << fault;
    }
}
