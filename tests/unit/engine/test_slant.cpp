/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_engine.h"
#include "engine/scene/scene_slant.h"
#include "engine/scene/swept_camera.h"
#include "optics/depth_scale.h"
#include "test_stack.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

using namespace dff;

namespace {

constexpr unsigned planes = 10;
const cv::Size size(320, 480);

TestStack stack_of(const SweptCamera &camera)
{
    TestStack stack(
        {PixelFormat::Rgb, static_cast<uint32_t>(size.width), static_cast<uint32_t>(size.height), planes});
    for (unsigned z = 0; z < planes; z++) {
        const cv::Mat3b picture = camera.digitise(camera.expose(z), z, 0);
        for (int y = 0; y < size.height; y++)
            std::memcpy(stack.memory.data() + stack.layout[z].offset +
                            stack.layout[z].stride * static_cast<size_t>(y),
                        picture.ptr(y), size_t{3} * size.width);
    }
    return stack;
}

} // namespace

class Slant : public testing::TestWithParam<double> {};

/* Where planes differ by little blur, two neighbours are equally sharp at every depth between them, and the
 * vertex over three of them lay half way between those two wherever the surface was. */
TEST_P(Slant, depth_has_no_stairs)
{
    SweptCameraSettings settings;
    settings.plan = SweepPlan::even(planes, 5.0, 0.0);
    settings.blur_step = GetParam();
    const SweptCamera camera(make_slant(size, 1), settings);
    const TestStack stack = stack_of(camera);

    DepthParameters parameters;
    parameters.method = Method::Volume;
    FocusEngine engine(Device::open(""), stack.shape, parameters);
    std::vector<uint16_t> depth(size_t{stack.shape.width} * stack.shape.height);
    DepthOutputs outputs;
    outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), stack.shape.width * sizeof(uint16_t)};
    ASSERT_TRUE(engine.compute(stack.view(), outputs));

    const DepthEncoder encoder = DepthEncoder::index(planes);
    const cv::Mat1w truth = camera.depth_map(0);
    double squares = 0.0;
    size_t count = 0;
    for (int y = 0; y < size.height; y++)
        for (int x = 8; x < size.width - 8; x++) {
            const double u = encoder.decode(truth(y, x)).value_or(-1.0);
            if (u < 1.0 || u > planes - 2.0)
                continue;
            const double error =
                encoder.decode(depth[static_cast<size_t>(y * size.width + x)]).value_or(-1.0) - u;
            squares += error * error;
            count++;
        }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(count)), 0.1);
}

INSTANTIATE_TEST_SUITE_P(BlurSteps, Slant, testing::Values(1.0, 1.5, 2.0, 4.0));
