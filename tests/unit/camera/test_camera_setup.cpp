/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/camera/camera_control.h"
#include "lenssweep/camera/camera_frame.h"
#include "lenssweep/camera/camera_setup.h"
#include "lenssweep/camera/link_load.h"
#include "lenssweep/camera/pixel_layout.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <stdexcept>
#include <vector>

namespace {

/* A camera that has just these features, and remembers what it was told. */
class ListedFeatures : public dff::CameraControl {
public:
    std::map<std::string, std::vector<std::string>> enumerations;
    std::map<std::string, std::pair<double, double>> numbers; /* with their range */
    std::map<std::string, std::pair<std::int64_t, std::int64_t>> integers;
    std::map<std::string, bool> booleans;
    std::vector<std::string> told;

    bool was_told(const std::string &what) const
    {
        return std::find(told.begin(), told.end(), what) != told.end();
    }

    bool has(const std::string &feature) override
    {
        return enumerations.contains(feature) || numbers.contains(feature) || integers.contains(feature) ||
               booleans.contains(feature);
    }
    bool is_integer(const std::string &feature) override { return integers.contains(feature); }
    bool is_command(const std::string &) override { return false; }
    std::string unit(const std::string &) override { return "1/m"; }
    double get_float(const std::string &) override { return 0; }
    void set_float(const std::string &feature, double value) override
    {
        tell(feature, std::to_string(value));
    }
    std::pair<double, double> float_range(const std::string &feature) override { return numbers.at(feature); }
    std::int64_t get_integer(const std::string &) override { return 0; }
    void set_integer(const std::string &feature, std::int64_t value) override
    {
        tell(feature, std::to_string(value));
    }
    std::pair<std::int64_t, std::int64_t> integer_range(const std::string &feature) override
    {
        return integers.at(feature);
    }
    std::string get_enumeration(const std::string &feature) override
    {
        return enumerations.at(feature).front();
    }
    void set_enumeration(const std::string &feature, const std::string &value) override
    {
        if (!has(feature))
            throw std::runtime_error(feature);
        tell(feature, value);
    }
    std::vector<std::string> enumeration_values(const std::string &feature) override
    {
        return enumerations.at(feature);
    }
    void execute(const std::string &command) override { told.push_back(command); }
    bool get_boolean(const std::string &feature) override { return booleans.at(feature); }
    void set_boolean(const std::string &feature, bool value) override
    {
        tell(feature, value ? "true" : "false");
    }
    void set_features(const std::string &text) override { told.push_back(text); }

private:
    void tell(const std::string &feature, const std::string &value)
    {
        told.push_back(feature + "=" + value); // NOLINT(performance-inefficient-string-concatenation)
    }
};

ListedFeatures full_camera()
{
    ListedFeatures camera;
    camera.enumerations = {{"AcquisitionMode", {"SingleFrame", "Continuous"}},
                           {"ExposureMode", {"Timed", "TriggerWidth"}},
                           {"ExposureAuto", {"Off", "Continuous"}},
                           {"TriggerSelector", {"AcquisitionStart", "FrameStart", "FrameBurstStart"}},
                           {"TriggerMode", {"Off", "On"}},
                           {"TriggerSource", {"Line0", "Line1", "Software"}},
                           {"TriggerActivation", {"RisingEdge", "FallingEdge"}},
                           {"TriggerOverlap", {"Off", "ReadOut"}}};
    camera.numbers = {{"ExposureTime", {10, 1e6}}, {"Gain", {0, 24}}, {"AcquisitionFrameRate", {1, 200}}};
    camera.booleans = {{"AcquisitionFrameRateEnable", true}};
    return camera;
}

} // namespace

TEST(TriggerSetup, one_frame_at_each_pulse_with_overlapping_readout)
{
    ListedFeatures camera = full_camera();
    dff::set_up_trigger(camera, {dff::TriggerKind::Line, "Line1", 156});
    for (const char *what :
         {"AcquisitionMode=Continuous", "ExposureMode=Timed", "ExposureAuto=Off",
          "TriggerSelector=FrameStart", "TriggerSource=Line1", "TriggerActivation=RisingEdge",
          "TriggerOverlap=ReadOut", "AcquisitionFrameRateEnable=false"})
        EXPECT_TRUE(camera.was_told(what)) << what;
    EXPECT_EQ(camera.told.back(), "TriggerMode=On");
    EXPECT_FALSE(camera.was_told("AcquisitionFrameRate=156.000000"));
}

TEST(TriggerSetup, a_plain_camera_is_told_what_it_has)
{
    ListedFeatures camera;
    camera.enumerations = {{"TriggerMode", {"Off", "On"}}, {"TriggerSource", {"Line0"}}};
    dff::set_up_trigger(camera, {dff::TriggerKind::Line, "Line0", 156});
    EXPECT_EQ(camera.told, (std::vector<std::string>{"TriggerSource=Line0", "TriggerMode=On"}));
}

TEST(TriggerSetup, an_unknown_source_is_an_error_with_the_list)
{
    ListedFeatures camera = full_camera();
    try {
        dff::set_up_trigger(camera, {dff::TriggerKind::Line, "Line9", 156});
        FAIL();
    } catch (const dff::CameraError &error) {
        EXPECT_NE(std::string(error.what()).find("Line0, Line1, Software"), std::string::npos)
            << error.what();
    }
    EXPECT_FALSE(camera.was_told("TriggerMode=On"));
}

TEST(TriggerSetup, a_free_running_camera_has_a_frame_rate)
{
    ListedFeatures camera = full_camera();
    dff::set_up_trigger(camera, {dff::TriggerKind::FreeRun, "", 156});
    EXPECT_TRUE(camera.was_told("TriggerMode=Off"));
    EXPECT_EQ(camera.told.back(), "AcquisitionFrameRate=156.000000");
}

TEST(CameraSettings, out_of_range_is_an_error_with_the_range)
{
    ListedFeatures camera = full_camera();
    EXPECT_THROW(dff::set_exposure(camera, 5), dff::CameraError);
    EXPECT_THROW(dff::set_gain(camera, 25), dff::CameraError);
    EXPECT_TRUE(camera.told.empty());
    dff::set_exposure(camera, 6000);
    EXPECT_EQ(camera.told.back(), "ExposureTime=6000.000000");
}

TEST(CameraSettings, older_cameras_have_other_names)
{
    ListedFeatures camera;
    camera.numbers = {{"ExposureTimeAbs", {10, 1e6}}};
    camera.integers = {{"GainRaw", {0, 10}}};
    dff::set_exposure(camera, 6000);
    dff::set_gain(camera, 3.4);
    EXPECT_EQ(camera.told, (std::vector<std::string>{"ExposureTimeAbs=6000.000000", "GainRaw=3"}));
}

TEST(PixelLayout, is_in_place_only_where_rows_are_multiples_of_four)
{
    const auto *mono = dff::layout_of_camera("Mono8");
    ASSERT_NE(mono, nullptr);
    EXPECT_TRUE(mono->usable_in_place(640));
    EXPECT_FALSE(mono->usable_in_place(642));
    EXPECT_EQ(mono->stride(641), 644U);
    EXPECT_FALSE(dff::layout_of_camera("Mono12")->usable_in_place(640));
    EXPECT_TRUE(dff::layout_of_camera("Mono16")->usable_in_place(640));
    EXPECT_TRUE(dff::layout_of_camera("BayerRG8")->is_bayer());
    EXPECT_EQ(dff::layout_of_camera("Mono12Packed"), nullptr);
    EXPECT_EQ(dff::layout_of_caps("video/x-bayer", "gbrg"), dff::layout_of_camera("BayerGB8"));
}

TEST(PixelLayout, ten_and_twelve_bits_become_full_scale)
{
    const std::vector<std::uint8_t> picture = {0xff, 0x03, 0x01, 0x00, 0x00, 0x02}; /* 1023, 1, 512 */
    std::vector<std::uint8_t> out(8, 0xee);
    dff::copy_picture(*dff::layout_of_camera("Mono10"), 3, 1, picture, out);
    EXPECT_EQ(out, (std::vector<std::uint8_t>{0xc0, 0xff, 0x40, 0x00, 0x00, 0x80, 0xee, 0xee}));
    const std::vector<std::uint8_t> most = {0xff, 0x0f};
    out.assign(4, 0);
    dff::copy_picture(*dff::layout_of_camera("Mono12"), 1, 1, most, out);
    EXPECT_EQ(out, (std::vector<std::uint8_t>{0xf0, 0xff, 0, 0}));
}

TEST(PixelLayout, rows_are_padded)
{
    const std::vector<std::uint8_t> picture = {1, 2, 3, 4, 5, 6};
    std::vector<std::uint8_t> out(8, 0);
    dff::copy_picture(*dff::layout_of_camera("Mono8"), 3, 2, picture, out);
    EXPECT_EQ(out, (std::vector<std::uint8_t>{1, 2, 3, 0, 4, 5, 6, 0}));
}

TEST(LinkLoad, is_equation_one_of_the_paper)
{
    /* 156 frames of 1920x1080 with one byte a pixel: "at least 3 Gb/s". */
    const dff::LinkLoad load{156, 1920 * 1080, 6000, 6410, 0, 0};
    EXPECT_NEAR(dff::paper_rate(load), 2.410, 0.001);
    EXPECT_NEAR(dff::link_rate(load), 2.588e9, 0.001e9);
    EXPECT_EQ(dff::complaint(load), "");
}

TEST(LinkLoad, counts_the_heads_of_packets)
{
    const dff::LinkLoad load{100, 1464 * 10, 1000, 10000, 1e9, 1500};
    EXPECT_DOUBLE_EQ(dff::link_rate(load), 100.0 * 8 * (14640 + 12 * 74));
}

TEST(LinkLoad, complains_with_the_figures)
{
    const std::string link = dff::complaint({156, 1920 * 1080, 6000, 6410, 1e9, 1500});
    EXPECT_NE(link.find("carries 1.000 Gbit/s"), std::string::npos) << link;
    EXPECT_NE(link.find("2.588"), std::string::npos) << link;
    EXPECT_NE(link.find("2.410"), std::string::npos) << link;
    const std::string exposure = dff::complaint({156, 1000, 7000, 6410, 1e9, 1500});
    EXPECT_NE(exposure.find("7000 us"), std::string::npos) << exposure;
}

TEST(ExposureClock, removes_the_jitter_of_arrivals)
{
    dff::ExposureClock clock;
    std::int64_t worst_ns = 0;
    for (int i = 0; i < 1000; i++) {
        const std::int64_t exposed_ns = 1'000'000'000 + i * std::int64_t{6'400'000};
        const std::int64_t late_ns = i % 7 * 500'000;
        const dff::CameraFrame frame{static_cast<std::uint64_t>(i),
                                     exposed_ns + 5'000'000'000 + exposed_ns / 10000,
                                     exposed_ns + 6'000'000 + late_ns};
        worst_ns = std::max(worst_ns, std::abs(clock.exposed_ns(frame, 6'000'000) - exposed_ns));
    }
    EXPECT_LT(worst_ns, 20'000);
}
