/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"
#include "engine/engine_error.h"
#include "engine/volume_method.h"
#include "test_stack.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;

namespace {

/* Depth and AIF of a stack whose left half is sharp in the nearest plane and the right half in the farthest.
 */
void expect_two_halves(const StackShape &shape)
{
    TestStack stack(shape);
    for (unsigned z = 0; z < shape.planes; z++)
        for (unsigned y = 0; y < shape.height; y++)
            for (unsigned x = 0; x < shape.width; x++) {
                const bool sharp = x < shape.width / 2 ? z == 0 : z == shape.planes - 1;
                const RowLayout &rows = stack.layout[z];
                stack.memory[rows.offset + rows.stride * y + x] =
                    std::byte(sharp ? (x / 5 + y / 5) % 2 * 200 + 20 : 120);
            }
    FocusEngine engine(Device::open(""), shape, {});
    std::vector<uint16_t> depth(size_t{shape.width} * shape.height);
    DepthOutputs outputs;
    outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), shape.width * sizeof(uint16_t)};
    ASSERT_TRUE(engine.compute(stack.view(), outputs));
    for (const unsigned y : {shape.height / 4, shape.height - shape.height / 4}) {
        EXPECT_LT(depth[size_t{y} * shape.width + shape.width / 8], 6000);
        EXPECT_GT(depth[size_t{y} * shape.width + shape.width - shape.width / 8], 59000);
    }

    AifComposer composer(Device::open(""), shape);
    std::vector<std::byte> picture(depth.size());
    composer.compose(stack.view(), {std::as_bytes(std::span(depth)), shape.width * sizeof(uint16_t)},
                     AifComposer::Blend::Sharp, picture,
                     packed_layout({shape.format, shape.width, shape.height, 1}));
    for (const unsigned x : {shape.width / 8, shape.width - shape.width / 8})
        EXPECT_NEAR(static_cast<double>(picture[size_t{shape.height / 2} * shape.width + x]),
                    (x / 5 + shape.height / 2 / 5) % 2 * 200 + 20, 12.0)
            << x;
}

} // namespace

TEST(Limits, smallest_picture)
{
    expect_two_halves({PixelFormat::Gray8, 64, 64, 2});
}

TEST(Limits, most_planes)
{
    expect_two_halves({PixelFormat::Gray8, 512, 512, 64});
}

TEST(Limits, largest_picture)
{
    expect_two_halves({PixelFormat::Gray8, 8192, 8192, 2});
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
        const uint64_t before = queue.allocated();
        VolumeMethod method(queue, shape, parameters);
        buffer.assign(stack.view());
        const cl::Buffer depth = queue.allocate(size_t{shape.width} * shape.height * sizeof(uint16_t));
        method.run(buffer, coder, {.sparse = true, .confidence = true, .motion = true}, depth);
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
