/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "found_lenses.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace {

namespace files = std::filesystem;

/* A machine with a webcam that focuses, one that does not, the lens of a sensor, a modem, and an Optotune
 * driver, as the kernel shows them. */
class FoundLenses : public testing::Test {
protected:
    void SetUp() override
    {
        write("class/video4linux/video0/name", "Webcam");
        write("class/video4linux/video1/name", "Fixed");
        write("class/video4linux/v4l-subdev2/name", "dw9807 10-000c");
        add_port("ttyACM0", "1-2", "Modems", "Modem");
        add_port("ttyACM1", "1-3", "Optotune", "Optotune LD");
        files::create_directories(root_ / "class/tty/ttyS0");
    }

    void TearDown() override { files::remove_all(root_); }

    void write(const files::path &path, const std::string &line)
    {
        files::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << line << "\n";
    }

    void add_port(const std::string &port, const std::string &usb, const std::string &maker,
                  const std::string &product)
    {
        write("devices/" + usb + "/manufacturer", maker);
        write("devices/" + usb + "/product", product);
        files::create_directories(root_ / "devices" / usb / (usb + ":1.0"));
        files::create_directories(root_ / "class/tty" / port);
        files::create_symlink(root_ / "devices" / usb / (usb + ":1.0"),
                              root_ / "class/tty" / port / "device");
    }

    dff::Machine machine() const
    {
        return {root_.string(), [](const std::string &device) -> std::optional<std::pair<int, int>> {
                    if (device == "/dev/video0")
                        return std::pair(0, 255);
                    if (device == "/dev/v4l-subdev2")
                        return std::pair(0, 1023);
                    return std::nullopt;
                }};
    }

    const files::path root_ = files::temp_directory_path() / ("dff-found-lenses-" + std::to_string(getpid()));
};

} // namespace

TEST_F(FoundLenses, cameras_sub_devices_and_drivers_are_found)
{
    const auto lenses = dff::find_lenses(machine());
    ASSERT_EQ(lenses.size(), 3U);
    EXPECT_EQ(lenses[0].kind, dff::FoundLens::Kind::Subdevice);
    EXPECT_EQ(lenses[0].uri, "v4l2:/dev/v4l-subdev2");
    EXPECT_EQ(lenses[1].kind, dff::FoundLens::Kind::Camera);
    EXPECT_EQ(lenses[1].name, "Webcam");
    EXPECT_EQ(lenses[2].kind, dff::FoundLens::Kind::Driver);
    EXPECT_EQ(lenses[2].uri, "optotune:/dev/ttyACM1");
}

TEST_F(FoundLenses, they_are_told_in_a_sentence)
{
    EXPECT_EQ(dff::describe(dff::find_lenses(machine())),
              "Found on this machine: /dev/v4l-subdev2 (dw9807 10-000c): focus 0 to 1023, "
              "lens=v4l2:/dev/v4l-subdev2; /dev/video0 (Webcam): focus 0 to 255, lens=v4l2:/dev/video0; "
              "/dev/ttyACM1 (Optotune LD): Optotune Lens Driver, lens=optotune:/dev/ttyACM1");
}

TEST_F(FoundLenses, a_machine_without_any_is_told_too)
{
    files::remove_all(root_);
    EXPECT_TRUE(dff::find_lenses(machine()).empty());
    EXPECT_NE(dff::describe({}).find("No lens"), std::string::npos);
}
