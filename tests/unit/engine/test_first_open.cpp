/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/device.h"

#include <gtest/gtest.h>
#include <latch>
#include <thread>

namespace {

/* A program of its own: only the first opening in a process looks for devices. */
TEST(FirstOpen, threads_that_come_at_once_all_find_a_device_with_memory)
{
    constexpr int threads = 8;
    std::latch together(threads);
    std::vector<uint64_t> memory(threads);
    {
        std::vector<std::jthread> running;
        for (uint64_t &found : memory)
            running.emplace_back([&] {
                together.arrive_and_wait();
                found = dff::Device::open("")->global_memory();
            });
    }
    for (const uint64_t found : memory)
        EXPECT_GT(found, 0U);
}

} // namespace
