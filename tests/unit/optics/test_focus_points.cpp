/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/focus_points.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace {

/* The points of a file with these lines, which is gone afterwards. */
dff::FocusPoints load(const std::string &lines)
{
    const auto path =
        std::filesystem::temp_directory_path() / ("dff-points-" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path) << "%YAML:1.0\n---\n" << lines;
    try {
        const auto points = dff::FocusPoints::load(path.string());
        std::filesystem::remove(path);
        return points;
    } catch (const std::invalid_argument &) {
        std::filesystem::remove(path);
        throw;
    }
}

std::string fault_of(const std::string &lines)
{
    try {
        load(lines);
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(FocusPoints, positions_lie_on_straight_lines_between_the_points)
{
    const auto points =
        load("lens: \"webcam\"\nunit: \"steps\"\nvergence: [ 0, 1, 5 ]\nposition: [ 40, 80, 220 ]\n");
    EXPECT_EQ(points.lens(), "webcam");
    EXPECT_EQ(points.unit(), "steps");
    EXPECT_DOUBLE_EQ(points.position(0), 40);
    EXPECT_DOUBLE_EQ(points.position(0.5), 60);
    EXPECT_DOUBLE_EQ(points.position(1), 80);
    EXPECT_DOUBLE_EQ(points.position(3), 150);
    EXPECT_DOUBLE_EQ(points.position(5), 220);
}

TEST(FocusPoints, two_are_enough_and_they_may_fall)
{
    const auto points = load("lens: \"a\"\nvergence: [ 0, 10 ]\nposition: [ 1000, 0 ]\n");
    EXPECT_EQ(points.unit(), "");
    EXPECT_DOUBLE_EQ(points.position(2), 800);
}

TEST(FocusPoints, nothing_is_guessed_beyond_them)
{
    const auto points = load("lens: \"webcam\"\nvergence: [ 0.5, 2 ]\nposition: [ 1, 2 ]\n");
    EXPECT_DOUBLE_EQ(points.nearest(), 2);
    EXPECT_DOUBLE_EQ(points.farthest(), 0.5);
    try {
        points.position(2.1);
        ADD_FAILURE();
    } catch (const std::invalid_argument &error) {
        EXPECT_NE(std::string(error.what()).find("webcam reach from 0.5 to 2 dioptres, not to 2.1"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_THROW(points.position(0.4), std::invalid_argument);
}

TEST(FocusPoints, what_is_wrong_is_said)
{
    EXPECT_NE(fault_of("vergence: [ 0, 1 ]\nposition: [ 0, 1 ]\n").find("lens is missing"),
              std::string::npos);
    EXPECT_NE(fault_of("lens: \"a\"\nvergence: [ 0 ]\nposition: [ 0 ]\n").find("2 to 1000"),
              std::string::npos);
    EXPECT_NE(fault_of("lens: \"a\"\nvergence: [ 0, 1 ]\nposition: [ 0, 1, 2 ]\n").find("length"),
              std::string::npos);
    EXPECT_NE(fault_of("lens: \"a\"\nvergence: [ 1, 0 ]\nposition: [ 0, 1 ]\n").find("greater than"),
              std::string::npos);
    EXPECT_NE(fault_of("lens: \"a\"\nvergence: [ 0, 1, 2 ]\nposition: [ 0, 2, 1 ]\n").find("only rise"),
              std::string::npos);
}
