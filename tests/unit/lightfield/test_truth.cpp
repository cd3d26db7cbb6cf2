/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/focus_engine.h"
#include "engine/scene/swept_camera.h"
#include "truth.h"

#include <gtest/gtest.h>
#include <span>

using namespace dff;

namespace {

LightFieldParameters five_views()
{
    LightFieldParameters parameters;
    parameters.layout = LightFieldLayout::Views;
    parameters.columns = 5;
    parameters.view_cone = 20.0 / 180.0 * CV_PI;
    return parameters;
}

/* The depth that the engine finds in a sweep over the scene. */
cv::Mat1w focus_depth(const Scene &scene)
{
    SweptCameraSettings settings;
    settings.plan = SweepPlan::even(10, 5.0, 0.0);
    const SweptCamera camera(scene, settings);
    const StackShape shape{PixelFormat::Rgb, static_cast<uint32_t>(scene.color.cols),
                           static_cast<uint32_t>(scene.color.rows), 10};
    std::vector<std::byte> memory;
    for (unsigned plane = 0; plane < shape.planes; plane++) {
        const cv::Mat3b picture = camera.digitise(camera.expose(plane), plane, 0);
        const auto bytes = std::as_bytes(std::span(picture.data, picture.total() * picture.elemSize()));
        memory.insert(memory.end(), bytes.begin(), bytes.end());
    }
    cv::Mat1w depth(scene.size());
    DepthOutputs outputs;
    outputs.depth = {reinterpret_cast<std::byte *>(depth.data), depth.step};
    FocusEngine engine(Device::open(""), shape, {});
    EXPECT_TRUE(engine.compute({shape, memory, packed_layout(shape)}, outputs));
    return depth;
}

/* Prints the PSNR of each view and returns that of the mutually visible pixels. */
std::vector<double> compare(const Truth &truth, const std::vector<cv::Mat3b> &views)
{
    std::vector<double> visible;
    for (unsigned view = 0; view < views.size(); view++) {
        const cv::Mat1b mask = truth.mutually_visible(view);
        visible.push_back(psnr(views[view], truth.views[view].color, mask));
        std::printf("slope %+.3f: whole %.2f dB, mutually visible (%.1f %%) %.2f dB\n", truth.slopes[view],
                    psnr(views[view], truth.views[view].color),
                    100.0 * cv::countNonZero(mask) / static_cast<double>(mask.total()), visible.back());
    }
    return visible;
}

} // namespace

TEST(Truth, views_are_what_shifted_cameras_see)
{
    const LightFieldParameters parameters = five_views();
    const Truth truth({480, 360}, parameters);
    const std::vector<cv::Mat3b> views =
        render_views(truth.middle.color, depth_map(truth.middle), parameters);
    const double parallax = parameters.depth_gain * (truth.slopes.back() - truth.slopes.front());
    EXPECT_GE(parallax, 0.02) << "the outermost views must differ";
    std::printf("from near to far, the outermost views differ by %.1f %% of the width\n", 100.0 * parallax);
    const std::vector<double> visible = compare(truth, views);
    for (unsigned view = 0; view < views.size(); view++)
        EXPECT_GE(visible[view], view == 0 || view + 1 == views.size() ? 25.0 : 30.0) << view;

    std::printf("with the depth from focus\n");
    const std::vector<double> from_focus =
        compare(truth, render_views(truth.middle.color, focus_depth(truth.middle), parameters));
    for (const double value : from_focus)
        EXPECT_GE(value, 22.0);
}
