/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/engine_error.h"
#include "engine/focus_engine.h"
#include "engine/volume_method.h"
#include "test_stack.h"
#include "two_halves.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;

TEST(Limits, smallest_picture)
{
    expect_two_halves({PixelFormat::Gray8, 64, 64, 2});
}

TEST(Limits, most_planes)
{
    expect_two_halves({PixelFormat::Gray8, 512, 512, 64});
}

TEST(Limits, large_picture)
{
    expect_two_halves({PixelFormat::Gray8, 8192, 8192, 2});
}

TEST(Limits, widest_picture)
{
    expect_two_halves({PixelFormat::Gray8, 16384, 64, 2});
    expect_two_halves({PixelFormat::Rgba64, 16384, 65, 3});
}

TEST(Limits, highest_picture)
{
    expect_two_halves({PixelFormat::Gray8, 64, 16384, 2});
}

TEST(Limits, too_large_a_stack_is_refused_before_anything_is_allocated)
{
    try {
        const FocusEngine engine(Device::open(""), {PixelFormat::Rgbx, 8192, 8192, 64}, {});
        FAIL() << "16 GiB on a device that can take at most half of its memory";
    } catch (const EngineError &error) {
        EXPECT_EQ(error.kind(), EngineError::Kind::TooLarge);
        EXPECT_NE(std::string(error.what()).find("16384 MiB"), std::string::npos) << error.what();
    }
}

TEST(Limits, what_the_method_needs_beside_the_stack_counts)
{
    DepthParameters parameters;
    parameters.scale = 2;
    try {
        const FocusEngine engine(Device::open(""), {PixelFormat::Gray8, 4096, 4096, 64}, parameters);
        FAIL() << "1 GiB of stack, but more than 4 to compute its depth, on a device of 8";
    } catch (const EngineError &error) {
        EXPECT_EQ(error.kind(), EngineError::Kind::TooLarge);
        EXPECT_NE(std::string(error.what()).find("use a larger scale"), std::string::npos) << error.what();
    }
}

TEST(Limits, volume_states_the_memory_it_takes)
{
    for (const auto &[format, scale] :
         {std::pair(PixelFormat::I420, 4u), {PixelFormat::Bgr, 2u}, {PixelFormat::Rgba64, 4u}}) {
        const StackShape shape{format, 640, 480, 6};
        DepthParameters parameters;
        parameters.scale = scale;
        CommandQueue queue(Device::open(""));
        const TestStack stack(shape);
        StackBuffer buffer(queue, shape);
        DepthCoder coder(queue, shape);
        coder.slopes(); /* whose room is the coder's */
        const uint64_t before = queue.allocated();
        VolumeMethod method(queue, shape, parameters);
        buffer.assign(stack.view());
        const cl::Buffer depth = queue.allocate(size_t{shape.width} * shape.height * sizeof(uint16_t));
        method.run(buffer, coder, {.sparse = true, .confidence = true, .motion = true, .uncertainty = true},
                   depth);
        queue.finish();
        const auto taken = static_cast<double>(queue.allocated() - before);
        EXPECT_NEAR(static_cast<double>(VolumeMethod::memory(shape, parameters)), taken, 0.03 * taken);
    }
}

TEST(Limits, an_unknown_device_is_named_with_those_there_are)
{
    try {
        Device::open("no such device");
        FAIL();
    } catch (const EngineError &error) {
        EXPECT_EQ(error.kind(), EngineError::Kind::NoDevice);
        EXPECT_NE(std::string(error.what()).find(Device::open("")->name()), std::string::npos)
            << error.what();
    }
}
