/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/blur_step.h"
#include "engine/guided_filter.h"
#include "engine/joint_upsampling.h"
#include "engine/noise_floor.h"
#include "engine/occlusion_doubt.h"
#include "engine/seen_through.h"
#include "engine/sub_plane.h"
#include "engine/uncertainty.h"
#include "twin_volume.h"

#include <cmath>
#include <gtest/gtest.h>

namespace dff {

/* Waves in both directions, whose sum Immerkaer's filter takes for free of noise; sharpest along a slope. */
inline TestStack silent_stack(const StackShape &shape)
{
    TestStack stack(shape);
    const std::vector<Component> components = shape.components();
    for (size_t c = 0; c < components.size(); c++)
        for (unsigned z = 0; z < shape.planes; z++)
            for (unsigned y = 0; y < components[c].height; y++)
                for (unsigned x = 0; x < components[c].width; x++) {
                    const float contrast = 1.0f / (1.0f + std::abs(z - 5.0f * x / components[c].width));
                    const float value =
                        128.0f + contrast * 30.0f * (std::sin(0.9f * x) + std::sin(0.8f * y + c));
                    const RowLayout &rows = stack.layout[c * shape.planes + z];
                    for (unsigned byte = 0; byte < components[c].sample_bytes; byte++)
                        stack.memory[rows.offset + rows.stride * y + components[c].sample_bytes * x + byte] =
                            static_cast<std::byte>(value);
                }
    return stack;
}

/* Pixels of blur a plane: of planes that lie close, and of those that do not. */
inline constexpr float close_planes = 2.0f, far_planes = 9.0f;

struct VolumeCase {
    PixelFormat format;
    unsigned width, height, planes, scale;
    bool silent;
};

class VolumeStages : public testing::TestWithParam<VolumeCase> {
protected:
    VolumeStages()
        : shape{GetParam().format, GetParam().width, GetParam().height, GetParam().planes},
          stack(GetParam().silent ? silent_stack(shape) : TestStack(shape)), queue(Device::open("")),
          buffer(queue, shape), low(shape, GetParam().scale), coder(queue, shape),
          noise_stage(queue, shape, low.scale), small_stage(queue, shape, low),
          focus_stage(queue, shape, low), pyramid(queue, low), blur_stage(queue, pyramid),
          floor_stage(queue, low), cost_stage(queue, low), guide_stage(queue, low), filter_stage(queue, low),
          matching(queue, low), doubt_stage(queue, low), sub_plane_stage(queue, low), fill_stage(queue, low),
          upsampling(queue, shape, low), uncertainty_stage(queue, shape, low),
          depth_map(queue.allocate(size_t{shape.width} * shape.height * sizeof(uint16_t)))
    {
        buffer.assign(stack.view());
        noise_stage.run(buffer);
        small_stage.run(buffer);
        focus_stage.run(buffer, noise_stage);
        pyramid.run(small_stage, noise_stage, buffer);
        noise = read_back<twin::Noise>(queue, noise_stage.noise(), 1)[0];
    }

    template <typename Cell>
    Volume read_cells(const cl::Buffer &buffer_on_device, float unit, unsigned pictures, unsigned first = 0,
                      unsigned step = 1)
    {
        const auto cells =
            read_back<Cell>(queue, buffer_on_device,
                            size_t{1} * ((pictures - 1) * step + first + 1) * low.height * low.stride);
        Volume volume(low.width, low.height, pictures);
        for (unsigned z = 0; z < pictures; z++)
            for (unsigned y = 0; y < volume.height; y++)
                for (unsigned x = 0; x < volume.width; x++)
                    volume.at(x, y, z) =
                        unit *
                        static_cast<float>(cells[((size_t{z} * step + first) * low.height + y) * low.stride +
                                                 LowShape::side + x]);
        return volume;
    }

    Volume read(const cl::Buffer &buffer_on_device, unsigned pictures)
    {
        return read_cells<float>(buffer_on_device, 1.0f, pictures);
    }

    /* Shorts of which `one` are 1. */
    Volume read_shorts(const cl::Buffer &buffer_on_device, unsigned pictures, float one)
    {
        return read_cells<cl_short>(buffer_on_device, 1.0f / one, pictures);
    }

    twin::Colours read_guide()
    {
        const auto colour = [&](unsigned i) { return read_cells<float>(guide_stage.guide(), 1.0f, 1, i); };
        return {colour(0), colour(1), colour(2)};
    }

    twin::Colours read_small()
    {
        const auto colour = [&](unsigned i) {
            return read_cells<cl_short>(small_stage.colours(), 1.0f / 16, shape.planes, i, 3);
        };
        return {colour(0), colour(1), colour(2)};
    }

    /* `rim`: cells at the border that may differ. */
    static void expect_alike(const Volume &found, const Volume &expected, float tolerance, unsigned rim = 0)
    {
        ASSERT_EQ(found.values.size(), expected.values.size());
        for (unsigned z = 0; z < found.planes; z++)
            for (unsigned y = rim; y + rim < found.height; y++)
                for (unsigned x = rim; x + rim < found.width; x++)
                    ASSERT_NEAR(found.at(x, y, z), expected.at(x, y, z), tolerance)
                        << x << "," << y << "," << z;
    }

    /* Rounding may decide between two planes alike. */
    static void expect_mostly(const Volume &found, const Volume &expected, float tolerance)
    {
        ASSERT_EQ(found.values.size(), expected.values.size());
        size_t other = 0;
        for (size_t i = 0; i < found.values.size(); i++)
            other += std::abs(found.values[i] - expected.values[i]) > tolerance;
        EXPECT_LE(other, found.values.size() / 100);
    }

    /* Runs everything up to the matching. */
    void run_to_matching()
    {
        cost_stage.run_fine(focus_stage.volume(), noise_stage);
        cost_stage.run_coarse(small_stage, noise_stage, close_planes);
        cost_stage.run_guess(noise_stage);
        guide_stage.run(cost_stage, small_stage, noise_stage);
        filter_stage.run(cost_stage.cost(), guide_stage.guide(), noise_stage);
        filter_stage.doubt(guide_stage.nearer(), noise_stage);
        matching.run(filter_stage.filtered(), guide_stage.guide(), noise_stage);
    }

    /* What `shape` says of them, read as the pictures of a level. */
    Volume read_level(const cl::Buffer &buffer_on_device, const LowShape &level, float one);

    void expect_noise_as_made();
    void expect_pyramid();
    void expect_falls();
    void expect_no_leak();
    void expect_occlusion_doubt();
    void expect_seen_through(Prefer prefer);
    void expect_sub_plane();
    void expect_small_planes_and_focus_volume();
    void expect_even_noise();
    void expect_cost_volume();
    void expect_guide_image();
    void expect_guided_filter_and_matching();
    void expect_doubt();
    void expect_fill_and_upsampling();
    void expect_confidence_and_sparse_depth();
    void expect_uncertainty(const Volume &decided, const Volume &matched);

    StackShape shape;
    TestStack stack;
    CommandQueue queue;
    StackBuffer buffer;
    LowShape low;
    DepthCoder coder;
    NoiseEstimate noise_stage;
    SmallPlanes small_stage;
    FocusVolume focus_stage;
    FocusPyramid pyramid;
    BlurStep blur_stage;
    NoiseFloor floor_stage;
    CostVolume cost_stage;
    GuideImage guide_stage;
    GuidedFilter filter_stage;
    SemiGlobalMatching matching;
    OcclusionDoubt doubt_stage;
    SubPlane sub_plane_stage;
    DepthFill fill_stage;
    JointUpsampling upsampling;
    Uncertainty uncertainty_stage;
    cl::Buffer depth_map;
    twin::Noise noise;
};

} // namespace dff
