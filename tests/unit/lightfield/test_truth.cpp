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
    parameters.rows = 1;
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

/* The mean colour of what a camera sees where a lens is, in the order of the channels. */
cv::Scalar seen_in(const cv::Mat3b &view, const cv::Rect &lens)
{
    return cv::mean(view(lens & cv::Rect({}, view.size())));
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

/* Eyes far away see one pixel through each round lens. It should have the mean, over the lens, of what a
 * camera that stands in the eye's direction sees. */
TEST(Truth, eyes_see_through_round_lenses_what_shifted_cameras_see)
{
    constexpr int pitch = 13;
    const cv::Size size{480, 360};
    LightFieldParameters parameters = five_views();
    const Truth truth(size, parameters);
    parameters.layout = LightFieldLayout::Elemental;
    parameters.lenses.pitch = pitch;
    parameters.lenses.gap =
        6.0 / truth.slopes.back();         /* the outermost eyes see the sixth pixel from the middle */
    parameters.lenses.center = {0.5, 0.5}; /* lenses stand over the middles of pixels */
    const cv::Mat3b panel = render(truth.middle.color, depth_map(truth.middle), parameters, size);
    for (int view = 0; view < 5; view++) {
        std::vector<cv::Vec3b> shown, expected;
        for (int y = size.height / 2 % pitch; y < size.height; y += pitch)
            for (int x = size.width / 2 % pitch + pitch; x < size.width - pitch; x += pitch) {
                const cv::Rect lens(x - pitch / 2, y - pitch / 2, pitch, pitch);
                const cv::Scalar mean = seen_in(truth.views[static_cast<size_t>(view)].color, lens);
                shown.push_back(panel(y, x - 3 * (view - 2)));
                expected.emplace_back(cv::saturate_cast<uchar>(mean[0]), cv::saturate_cast<uchar>(mean[1]),
                                      cv::saturate_cast<uchar>(mean[2]));
            }
        const double found = psnr(cv::Mat3b(shown), cv::Mat3b(expected));
        std::printf("eye at slope %+.3f: %.2f dB\n", truth.slopes[static_cast<size_t>(view)], found);
        EXPECT_GE(found, 26.0) << "20 dB where detail that is finer than the lenses is not left out";
    }
}

/* The same under cylinders that stand upright, a colour and a row at a time. */
TEST(Truth, eyes_see_through_cylindrical_lenses_what_shifted_cameras_see)
{
    constexpr int pitch = 9;
    const cv::Size size{480, 360};
    LightFieldParameters parameters = five_views();
    const Truth truth(size, parameters);
    parameters.layout = LightFieldLayout::Lenticular;
    parameters.sheet.pitch = static_cast<double>(size.width) / pitch;
    parameters.view_cone *= 1.25; /* so that the eyes are at a tenth, three tenths... of it */
    const cv::Mat3b panel = render(truth.middle.color, depth_map(truth.middle), parameters, size);
    for (int view = 0; view < 5; view++) {
        double squares = 0.0;
        int count = 0;
        for (int lens = 1; lens + 1 < size.width / pitch; lens++) {
            /* The subpixel c of x is 0.5 + c / 3 from the pixel's left side. */
            const auto subpixel =
                static_cast<int>(std::lround(3.0 * ((lens + 0.1 + 0.2 * view) * pitch - 0.5)));
            const int x = subpixel / 3, c = subpixel % 3;
            for (int y = 0; y < size.height; y++, count++) {
                const cv::Scalar mean =
                    seen_in(truth.views[static_cast<size_t>(view)].color, {x - pitch / 2, y, pitch, 1});
                squares += std::pow(panel(y, x)[c] - mean[c], 2.0);
            }
        }
        const double found = 10.0 * std::log10(255.0 * 255.0 * count / squares);
        std::printf("eye at slope %+.3f: %.2f dB\n", truth.slopes[static_cast<size_t>(view)], found);
        EXPECT_GE(found, 28.5) << "23 to 25 dB where detail that is finer than the lenses is not left out";
    }
}
