/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "open_lens.h"

#include <gtest/gtest.h>

namespace {

std::string error_of(const std::string &uri)
{
    try {
        dff::open_lens(dff::LensUri::parse(uri), {});
    } catch (const dff::LensError &error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(OpenLens, no_lens_is_one_that_nobody_moves)
{
    const auto lens = dff::open_lens(dff::LensUri::parse("none"), {});
    EXPECT_EQ(dynamic_cast<dff::SteppedLens *>(lens.get()), nullptr);
    EXPECT_EQ(dynamic_cast<dff::SequencedLens *>(lens.get()), nullptr);
    EXPECT_EQ(lens->code(0), -1);
}

TEST(OpenLens, missing_device_says_what_to_do)
{
    EXPECT_NE(error_of("fpga:/dev/i2c-none").find("i2c-dev"), std::string::npos);
    EXPECT_NE(error_of("max14574:/dev/i2c-none").find("i2c-dev"), std::string::npos);
    EXPECT_NE(error_of("v4l2:/dev/video-none").find("v4l2-ctl"), std::string::npos);
    EXPECT_NE(error_of("v4l2:/dev/null").find("focus_absolute"), std::string::npos);
    EXPECT_NE(error_of("genicam:FocalPower").find("lenssweepsrc"), std::string::npos);
}

TEST(OpenLens, profile_that_cannot_be_read_is_named)
{
    EXPECT_NE(error_of("max14574:/dev/null").find("/dev/null"), std::string::npos);
}
