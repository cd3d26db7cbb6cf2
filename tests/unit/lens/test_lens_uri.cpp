/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lens_uri.h"

#include <gtest/gtest.h>

using dff::LensKind;
using dff::LensUri;

TEST(LensUri, each_kind_is_read)
{
    EXPECT_EQ(LensUri::parse("none").kind, LensKind::None);
    EXPECT_EQ(LensUri::parse("").kind, LensKind::None);

    const LensUri fpga = LensUri::parse("fpga:/dev/i2c-1@0x3d");
    EXPECT_EQ(fpga.kind, LensKind::Fpga);
    EXPECT_EQ(fpga.device, "/dev/i2c-1");
    EXPECT_EQ(fpga.address, 0x3d);

    const LensUri driver = LensUri::parse("max14574:/dev/i2c-7@118");
    EXPECT_EQ(driver.kind, LensKind::Max14574);
    EXPECT_EQ(driver.device, "/dev/i2c-7");
    EXPECT_EQ(driver.address, 118);

    EXPECT_EQ(LensUri::parse("genicam:FocalPower").feature, "FocalPower");
    const LensUri optotune = LensUri::parse("optotune:/dev/serial/by-id/usb-Optotune");
    EXPECT_EQ(optotune.kind, LensKind::Optotune);
    EXPECT_EQ(optotune.device, "/dev/serial/by-id/usb-Optotune");

    const LensUri element = LensUri::parse("element:the.cam.lens-position");
    EXPECT_EQ(element.kind, LensKind::Element);
    EXPECT_EQ(element.element, "the.cam");
    EXPECT_EQ(element.feature, "lens-position");
    EXPECT_EQ(LensUri::parse("v4l2:/dev/v4l/by-id/usb-a:b@c").device, "/dev/v4l/by-id/usb-a:b@c");
}

TEST(LensUri, address_may_be_left_out)
{
    EXPECT_EQ(LensUri::parse("fpga:/dev/i2c-1").address, 0x3c);
    EXPECT_EQ(LensUri::parse("max14574:/dev/i2c-1").address, 0x77);
}

TEST(LensUri, what_is_wrong_is_told_with_what_is_allowed)
{
    for (const char *text :
         {"fpga", "fpga:", "fpga:@0x3c", "fpga:/dev/i2c-1@", "fpga:/dev/i2c-1@0x78", "max14574:/dev/i2c-1@3",
          "max14574:/dev/i2c-1@0x77x", "genicam", "genicam:", "v4l2:", "element:", "element:cam",
          "element:cam.", "element:.focus", "optotune:", "/dev/video0", "None"}) {
        try {
            LensUri::parse(text);
            ADD_FAILURE() << text;
        } catch (const std::invalid_argument &error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(text), std::string::npos) << message;
            EXPECT_NE(message.find("v4l2:/dev/video0"), std::string::npos) << message;
        }
    }
}
