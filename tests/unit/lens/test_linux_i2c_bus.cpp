/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "linux_i2c_bus.h"

#include <gtest/gtest.h>

TEST(LinuxI2cBus, missing_device_says_what_to_do)
{
    try {
        dff::LinuxI2cBus bus("/dev/i2c-does-not-exist", 0x3c);
        FAIL() << "opened";
    } catch (const dff::I2cError &error) {
        EXPECT_NE(std::string(error.what()).find("i2c-dev"), std::string::npos);
    }
}

TEST(LinuxI2cBus, file_that_is_no_bus_is_an_error)
{
    EXPECT_THROW(dff::LinuxI2cBus("/dev/null", 0x3c), dff::I2cError);
}
