/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "light_field_settings.h"

#include "display_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace dff {

namespace {

constexpr double default_cone = 40.0;    /* degrees, of most Looking Glass displays */
constexpr uint32_t largest_quilt = 4096; /* pixels a side that any decoder takes */

/* Views as large as the picture allows, in a quilt that is not too large. */
PictureSize quilt_size(const LightFieldParameters &parameters, PictureSize picture)
{
    const double aspect = parameters.view_aspect > 0.0 ? parameters.view_aspect
                                                       : static_cast<double>(picture.width) / picture.height;
    const double height = std::min({static_cast<double>(picture.height), picture.width / aspect,
                                    static_cast<double>(largest_quilt) / parameters.rows,
                                    largest_quilt / (aspect * parameters.columns)});
    const auto even = [](double length) { return std::max(2U, static_cast<uint32_t>(length / 2.0) * 2); };
    return {even(height * aspect) * parameters.columns, even(height) * parameters.rows};
}

/* Lenses so near to the panel that rays lie nearly flat have no picture. */
void check_gap(const LensArray &lenses)
{
    const double least = lenses.pitch / 16.0;
    if (lenses.gap > 0.0 && lenses.gap < least)
        throw std::runtime_error(
            "gap is " + std::to_string(lenses.gap) +
            " pixels and must be 0, or at least a sixteenth of pitch: " + std::to_string(least));
}

} // namespace

LightFieldPlan::LightFieldPlan(const LightFieldSettings &settings, PictureSize picture)
    : parameters(settings.parameters), output(picture)
{
    const LightFieldLayout layout = parameters.layout;
    const bool is_quilt = layout == LightFieldLayout::Quilt;
    double cone = settings.view_cone * std::numbers::pi / 180.0;
    parameters.columns = parameters.columns ? parameters.columns : is_quilt ? 8 : 2;
    parameters.rows = parameters.rows ? parameters.rows : is_quilt ? 6 : 1;
    any_size = layout != LightFieldLayout::Rgbd && layout != LightFieldLayout::Lenticular;

    if (layout == LightFieldLayout::Lenticular) {
        if (settings.calibration.empty())
            throw std::runtime_error(
                "layout=lenticular needs display-calibration: the path of the file that says how "
                "the display's lenses lie over its panel");
        const DisplayCalibration calibration = DisplayCalibration::load(settings.calibration);
        parameters.sheet = calibration.sheet;
        output = calibration.panel;
        cone = cone > 0.0 ? cone : calibration.view_cone;
    } else if (layout == LightFieldLayout::Rgbd) {
        const bool beside =
            parameters.depth_side == DepthSide::Right || parameters.depth_side == DepthSide::Left;
        (beside ? output.width : output.height) *= 2;
    } else if (layout == LightFieldLayout::Elemental) {
        check_gap(parameters.lenses);
    } else if (is_quilt) {
        output = settings.quilt.width ? settings.quilt : quilt_size(parameters, picture);
    } else if (layout == LightFieldLayout::Views) {
        LightFieldParameters one = parameters;
        one.columns = one.rows = 1;
        output = quilt_size(one, picture);
        output.width *= parameters.columns;
        output.height *= parameters.rows;
    }
    parameters.view_cone = cone > 0.0 ? cone : default_cone * std::numbers::pi / 180.0;
}

} // namespace dff
