/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "truth.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

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
    for (unsigned view = 0; view < views.size(); view++) {
        const cv::Mat1b mask = truth.mutually_visible(view);
        const double visible = psnr(views[view], truth.views[view].color, mask);
        std::printf("slope %+.3f: whole %.2f dB, mutually visible (%.1f %%) %.2f dB\n", truth.slopes[view],
                    psnr(views[view], truth.views[view].color), 100.0 * cv::countNonZero(mask) / mask.total(),
                    visible);
        const bool outermost = view == 0 || view + 1 == views.size();
        EXPECT_GE(visible, outermost ? 25.0 : 30.0) << view;
        if (const char *folder = std::getenv("DFF_KEEP_PICTURES")) {
            cv::Mat3b both, bgr;
            cv::hconcat(views[view], truth.views[view].color, both);
            cv::cvtColor(both, bgr, cv::COLOR_RGB2BGR);
            cv::imwrite(folder + ("/view" + std::to_string(view)) + ".png", bgr);
        }
    }
}
