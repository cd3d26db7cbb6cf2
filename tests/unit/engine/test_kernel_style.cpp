/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Which kernels a device gets, and what is remembered of its driver. */
#include "engine/engine_error.h"
#include "engine/opencl/device.h"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace dff;

namespace {

/* A cache folder of the test's own, and a CPU that tiles are known to suit. */
class KernelStyles : public testing::Test {
protected:
    KernelStyles() : device_(Device::open("")->device(), KernelStyle::Pixels)
    {
        std::string name = testing::TempDir() + "styles-XXXXXX";
        folder_ = mkdtemp(name.data());
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
        unsetenv("DFF_KERNELS");
    }
    ~KernelStyles() override { std::filesystem::remove_all(folder_); }

    KernelStyle choose(bool tiles_are_right, bool pixels_are_right)
    {
        return choose_kernel_style(device_, [=, this](KernelStyle style) {
            tests_++;
            return style == KernelStyle::Tiles ? tiles_are_right : pixels_are_right;
        });
    }

    /* A process whose driver ends it in the self-test of `fatal`. */
    void die_in(KernelStyle fatal)
    {
        const pid_t child = fork();
        if (child == 0) {
            choose_kernel_style(device_, [=](KernelStyle style) -> bool {
                if (style == fatal)
                    _exit(42);
                return false;
            });
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(WEXITSTATUS(status), 42);
    }

    Device device_;
    std::filesystem::path folder_;
    int tests_ = 0;
};

} // namespace

TEST_F(KernelStyles, a_driver_is_tested_once)
{
    EXPECT_EQ(choose(true, true), KernelStyle::Tiles);
    EXPECT_EQ(tests_, 1);
    EXPECT_EQ(choose(false, false), KernelStyle::Tiles);
    EXPECT_EQ(tests_, 1);
}

TEST_F(KernelStyles, where_tiles_compute_wrong_it_is_pixels)
{
    EXPECT_EQ(choose(false, true), KernelStyle::Pixels);
    EXPECT_EQ(choose(true, true), KernelStyle::Pixels) << "remembered";
    EXPECT_EQ(tests_, 2);
}

TEST_F(KernelStyles, where_both_compute_wrong_it_is_an_error_that_names_the_driver)
{
    for (int time = 0; time < 2; time++)
        try {
            choose(false, false);
            FAIL() << "no error";
        } catch (const EngineError &error) {
            const std::string text = error.what();
            EXPECT_NE(text.find(device_.name()), std::string::npos) << text;
            EXPECT_NE(text.find(device_.device().getInfo<CL_DRIVER_VERSION>()), std::string::npos) << text;
            EXPECT_NE(text.find(folder_.string()), std::string::npos) << text;
        }
    EXPECT_EQ(tests_, 2);
}

TEST_F(KernelStyles, tiles_that_end_the_process_twice_are_left)
{
    die_in(KernelStyle::Tiles);
    die_in(KernelStyle::Tiles);
    EXPECT_EQ(choose(true, true), KernelStyle::Pixels);
    EXPECT_EQ(tests_, 1);
}

TEST_F(KernelStyles, a_self_test_that_was_ended_from_without_is_begun_again)
{
    die_in(KernelStyle::Tiles);
    EXPECT_EQ(choose(true, true), KernelStyle::Tiles);
}

TEST_F(KernelStyles, a_driver_that_always_ends_the_process_is_an_error)
{
    for (const KernelStyle style :
         {KernelStyle::Tiles, KernelStyle::Tiles, KernelStyle::Pixels, KernelStyle::Pixels})
        die_in(style);
    EXPECT_THROW(choose(true, true), EngineError);
}

TEST_F(KernelStyles, the_environment_forces_one)
{
    setenv("DFF_KERNELS", "pixels", 1);
    EXPECT_EQ(choose(true, true), KernelStyle::Pixels);
    setenv("DFF_KERNELS", "tiles", 1);
    EXPECT_EQ(choose(false, false), KernelStyle::Tiles);
    EXPECT_EQ(tests_, 0);
    setenv("DFF_KERNELS", "fast", 1);
    EXPECT_THROW(choose(true, true), EngineError);
    unsetenv("DFF_KERNELS");
}

TEST_F(KernelStyles, who_comes_meanwhile_waits_for_the_first)
{
    std::atomic<int> tests = 0;
    const auto slow = [&](KernelStyle) {
        tests++;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return true;
    };
    {
        std::vector<std::jthread> together;
        for (int i = 0; i < 4; i++)
            together.emplace_back([&] { EXPECT_EQ(choose_kernel_style(device_, slow), KernelStyle::Tiles); });
    }
    EXPECT_EQ(tests, 1);
}

TEST_F(KernelStyles, works_where_nothing_can_be_written)
{
    setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
    EXPECT_EQ(choose(false, true), KernelStyle::Pixels);
    EXPECT_EQ(choose(true, true), KernelStyle::Tiles) << "not remembered";
}
