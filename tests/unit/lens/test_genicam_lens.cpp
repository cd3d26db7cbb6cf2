/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "genicam_lens.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <thread>
#include <unistd.h>

using namespace std::chrono_literals;

namespace {

/* A camera with the features it is given, and a record of what was set. */
class FakeCamera : public dff::CameraFeatures {
public:
    std::map<std::string, std::pair<double, double>> floats;
    std::map<std::string, std::pair<std::int64_t, std::int64_t>> integers;
    std::map<std::string, std::deque<std::string>> statuses; /* what is read; the last one stays */
    std::vector<std::string> commands;
    std::vector<std::string> done;
    bool broken = false;

    bool has(const std::string &feature) override
    {
        return floats.contains(feature) || integers.contains(feature) || statuses.contains(feature) ||
               std::find(commands.begin(), commands.end(), feature) != commands.end();
    }
    bool is_integer(const std::string &feature) override { return integers.contains(feature); }
    bool is_command(const std::string &feature) override
    {
        return std::find(commands.begin(), commands.end(), feature) != commands.end();
    }
    std::string unit(const std::string &) override { return "1/m"; }
    double get_float(const std::string &) override { return 0; }
    void set_float(const std::string &feature, double value) override
    {
        note(feature + "=" + std::to_string(value));
    }
    std::pair<double, double> float_range(const std::string &feature) override { return floats.at(feature); }
    std::int64_t get_integer(const std::string &) override { return 0; }
    void set_integer(const std::string &feature, std::int64_t value) override
    {
        note(feature + "=" + std::to_string(value));
    }
    std::pair<std::int64_t, std::int64_t> integer_range(const std::string &feature) override
    {
        return integers.at(feature);
    }
    std::string get_enumeration(const std::string &feature) override
    {
        auto &values = statuses.at(feature);
        std::string value = values.front();
        if (values.size() > 1)
            values.pop_front();
        return value;
    }
    void set_enumeration(const std::string &feature, const std::string &value) override
    {
        note(feature + "=" + value);
    }
    std::vector<std::string> enumeration_values(const std::string &feature) override
    {
        return {statuses.at(feature).begin(), statuses.at(feature).end()};
    }
    void execute(const std::string &command) override { note(command); }

private:
    void note(const std::string &what)
    {
        if (broken)
            throw std::runtime_error(what + ": no answer");
        done.push_back(what);
    }
};

dff::LensSweep sweep(unsigned planes, double near, double far)
{
    return {dff::SweepPlan::even(planes, near, far)};
}

} // namespace

TEST(GenicamLens, focal_power_takes_the_plans_dioptres)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {-2.0, 6.0};
    dff::GenicamLens lens(camera, "FocalPower", {});
    EXPECT_TRUE(lens.calibrated());
    lens.prepare(sweep(3, 5.0, 0.0));
    lens.start();
    lens.move_to(1);
    EXPECT_EQ(camera.done, (std::vector<std::string>{"FocalPower=2.500000"}));
    EXPECT_EQ(lens.code(1), -1);
    EXPECT_THROW(lens.prepare(sweep(3, 7.0, 0.0)), std::invalid_argument);
}

TEST(GenicamLens, stepper_is_swept_over_its_whole_range)
{
    FakeCamera camera;
    camera.integers["FocusStepper"] = {10, 20};
    dff::GenicamLens lens(camera, "FocusStepper", {});
    EXPECT_FALSE(lens.calibrated());
    lens.prepare(sweep(3, 5.0, 0.0));
    EXPECT_EQ(lens.code(0), 20);
    EXPECT_EQ(lens.code(1), 15);
    EXPECT_EQ(lens.code(2), 10);
    lens.move_to(2);
    EXPECT_EQ(camera.done.back(), "FocusStepper=10");
    EXPECT_THROW(lens.prepare(sweep(12, 5.0, 0.0)), std::invalid_argument); /* 11 positions */
}

TEST(GenicamLens, optics_are_selected_and_initialised_before_the_first_move)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {0.0, 6.0};
    camera.statuses["OpticControllerSelector"] = {"OpticController0", "OpticController1"};
    camera.statuses["OpticControllerStatus"] = {"NotInitialized", "NotInitialized", "Busy", "Ready"};
    camera.commands = {"OpticControllerInitialize"};
    dff::GenicamLens lens(camera, "FocalPower", {});
    lens.prepare(sweep(2, 5.0, 0.0));
    lens.start();
    EXPECT_EQ(camera.done, (std::vector<std::string>{"OpticControllerSelector=OpticController0",
                                                     "OpticControllerInitialize"}));
    lens.start(); /* once is enough */
    EXPECT_EQ(camera.done.size(), 2U);
}

TEST(GenicamLens, a_makers_lens_is_connected_first_and_a_focus_that_needs_it_is_initialised)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {0.0, 6.0};
    camera.statuses["LensStatus"] = {"NotConnected", "NotConnected", "Busy", "Ready"};
    camera.statuses["FocusStatus"] = {"NotInitialized", "Busy", "Ready"};
    camera.commands = {"FocusInitialize", "LensConnect"};
    dff::GenicamLens lens(camera, "FocalPower", {});
    lens.prepare(sweep(2, 5.0, 0.0));
    lens.start();
    EXPECT_EQ(camera.done, (std::vector<std::string>{"LensConnect", "FocusInitialize"}));
    EXPECT_EQ(camera.statuses["LensStatus"].front(), "Ready");
    EXPECT_EQ(camera.statuses["FocusStatus"].front(), "Ready");
}

TEST(GenicamLens, what_is_called_like_a_command_and_is_none_is_let_be)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {0.0, 6.0};
    camera.statuses["LensConnection"] = {"Auto"};
    dff::GenicamLens lens(camera, "FocalPower", {});
    lens.start();
    EXPECT_TRUE(camera.done.empty());
}

TEST(GenicamLens, focus_status_is_asked_until_the_lens_rests)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {0.0, 6.0};
    camera.statuses["FocusStatus"] = {"Busy", "NotReady", "Ready", "Busy"};
    dff::GenicamLens lens(camera, "FocalPower", {});
    EXPECT_TRUE(lens.wait_settled({}));
    EXPECT_EQ(camera.statuses["FocusStatus"].size(), 1U);
}

TEST(GenicamLens, waiting_can_be_interrupted)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {0.0, 6.0};
    camera.statuses["FocusStatus"] = {"Busy"};
    dff::GenicamLens lens(camera, "FocalPower", {});
    std::stop_source stop;
    const auto begin = std::chrono::steady_clock::now();
    std::jthread stopper([&stop] {
        std::this_thread::sleep_for(5ms);
        stop.request_stop();
    });
    EXPECT_FALSE(lens.wait_settled(stop.get_token()));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
}

TEST(GenicamLens, lens_that_has_failed_is_an_error)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {0.0, 6.0};
    camera.statuses["FocusStatus"] = {"Busy", "Error"};
    dff::GenicamLens lens(camera, "FocalPower", {});
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THROW(lens.wait_settled({}), dff::LensError);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s); /* no need to wait on */
}

TEST(GenicamLens, camera_that_does_not_answer_is_an_error)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {0.0, 6.0};
    dff::GenicamLens lens(camera, "FocalPower", {});
    lens.prepare(sweep(2, 5.0, 0.0));
    camera.broken = true;
    try {
        lens.move_to(0);
        FAIL() << "no error";
    } catch (const dff::LensError &error) {
        EXPECT_NE(std::string(error.what()).find("FocalPower"), std::string::npos);
    }
}

TEST(GenicamLens, missing_feature_is_an_error_that_says_where_to_look)
{
    FakeCamera camera;
    try {
        dff::GenicamLens lens(camera, "FocalPower", {});
        FAIL() << "no error";
    } catch (const dff::LensError &error) {
        EXPECT_NE(std::string(error.what()).find("OpticControl"), std::string::npos);
    }
}

namespace {

std::optional<dff::FocusPoints> points_of(const std::string &lines)
{
    const auto path =
        std::filesystem::temp_directory_path() / ("dff-genicam-" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path) << "%YAML:1.0\n---\nlens: \"theirs\"\n" << lines;
    auto points = dff::FocusPoints::load(path.string());
    std::filesystem::remove(path);
    return points;
}

} // namespace

TEST(GenicamLens, raw_codes_come_by_the_points_of_a_profile)
{
    FakeCamera camera;
    camera.integers["LensVoltage"] = {0, 1000};
    dff::GenicamLens lens(camera, "LensVoltage", points_of("vergence: [ 0, 10 ]\nposition: [ 800, 301 ]\n"));
    EXPECT_TRUE(lens.calibrated());
    lens.prepare(sweep(3, 10.0, 0.0));
    EXPECT_EQ(lens.code(0), 301);
    EXPECT_EQ(lens.code(1), 551);
    EXPECT_EQ(lens.code(2), 800);
    EXPECT_THROW(lens.prepare(sweep(3, 11.0, 0.0)), std::invalid_argument); /* beyond the points */
}

TEST(GenicamLens, range_is_told_with_the_cameras_unit)
{
    FakeCamera camera;
    camera.floats["FocalPower"] = {-2.0, 6.0};
    dff::GenicamLens lens(camera, "FocalPower", {});
    try {
        lens.prepare(sweep(3, 7.0, 0.0));
        ADD_FAILURE();
    } catch (const std::invalid_argument &error) {
        EXPECT_NE(std::string(error.what()).find("FocalPower of the camera is -2 to 6 1/m, not 7"),
                  std::string::npos)
            << error.what();
    }
}
