/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "light_field_disparity.h"

#include "engine/light_field_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dff {

namespace {

/* How the views look at the plane of zero parallax, as slopes: tan of the angle. */
struct ViewSlopes {
    double outermost; /* between the first view and the last */
    double next;      /* at most, from one to the next */
    double sample;    /* spatial sample of the display, pixels; infinite where views have no neighbours */
};

ViewSlopes slopes_of_views(unsigned views, double cone)
{
    if (views < 2)
        return {0.0, 0.0, 0.0};
    const double last = view_slope(views - 1, views, cone);
    const double sample = views == 2 ? std::numeric_limits<double>::infinity() : 1.0;
    return {2.0 * last, last - view_slope(views - 2, views, cone), sample};
}

ViewSlopes slopes_of(const LightFieldParameters &parameters, PictureSize output)
{
    constexpr double subpixels = 3.0; /* of a pixel; an eye sees one of them through a cylinder */
    switch (parameters.layout) {
    case LightFieldLayout::Rgbd:
        return {0.0, 0.0, 0.0};
    case LightFieldLayout::Lenticular: {
        const double pitch = output.width / parameters.sheet.pitch;
        const double all = 2.0 * std::tan(parameters.view_cone / 2.0);
        return {all, all / (subpixels * pitch), pitch};
    }
    case LightFieldLayout::Elemental: {
        const double pitch = parameters.lenses.pitch, gap = lens_gap(parameters);
        return {pitch / gap, 1.0 / gap, pitch};
    }
    default:
        return slopes_of_views(parameters.columns * parameters.rows, parameters.view_cone);
    }
}

} // namespace

LightFieldDisparity::LightFieldDisparity(const LightFieldParameters &parameters, PictureSize output)
{
    const ViewSlopes slopes = slopes_of(parameters, output);
    if (slopes.outermost == 0.0)
        return;
    const int width = LightFieldGeometry(parameters, output, output).view.x;
    const double height =
        std::abs(parameters.depth_gain) * width *
        std::max(std::abs(parameters.zero_parallax), std::abs(1.0 - parameters.zero_parallax));
    outermost = slopes.outermost * height;
    sharp = slopes.outermost / slopes.next * slopes.sample;
    sharp_gain = outermost > 0.0 ? parameters.depth_gain * sharp / outermost : parameters.depth_gain;
}

} // namespace dff
