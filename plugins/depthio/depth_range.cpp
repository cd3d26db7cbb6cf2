/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/depth_range.h"

#include "optics/dioptre.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace dff {

namespace {

constexpr double steps = DepthScale::max_pixel - 1;

} // namespace

DepthScale dioptre_scale(double near, double far)
{
    const double step = (far - near) / steps;
    return {DepthUnit::Dioptre, step, near - step};
}

DepthRange::DepthRange(DepthScale scale, std::optional<double> near, std::optional<double> far)
    : unit_(scale.unit), scale_(scale.scale), offset_(scale.offset)
{
    if (!in_dioptres())
        return;
    if (unit_ == DepthUnit::Dioptre) {
        near = near.value_or(scale.value(1));
        far = far.value_or(scale.value(DepthScale::max_pixel));
    }
    if (!near || !far)
        throw std::invalid_argument(
            "The range of the depth is not known: set near and far, in dioptres (1 / metres)");
    if (!std::isfinite(scale_) || !std::isfinite(offset_) || scale_ == 0.0)
        throw std::invalid_argument("The depth's scale is " + std::to_string(scale_) + " and its offset " +
                                    std::to_string(offset_) + ": that says no distances");
    if (!(*near > *far) || !std::isfinite(*near - *far))
        throw std::invalid_argument("near is " + std::to_string(*near) + " and far is " +
                                    std::to_string(*far) +
                                    " dioptres: near must be the greater number, and both finite");
    near_ = *near;
    far_ = *far;
}

std::optional<double> DepthRange::position(uint16_t pixel) const
{
    if (pixel == DepthScale::no_value)
        return std::nullopt;
    if (!in_dioptres())
        return (pixel - 1) / steps;
    const double value = offset_ + scale_ * pixel;
    const double power = unit_ == DepthUnit::Dioptre ? value : dioptre_from_millimetre(value);
    return std::clamp((near_ - power) / (near_ - far_), 0.0, 1.0);
}

uint16_t DepthRange::pixel(double position) const
{
    double pixel = 1.0 + steps * position;
    if (in_dioptres()) {
        const double power = near_ - position * (near_ - far_);
        const double value = unit_ == DepthUnit::Dioptre ? power : millimetre_from_dioptre(power);
        pixel = (value - offset_) / scale_;
    }
    return static_cast<uint16_t>(std::clamp(std::round(pixel), 1.0, steps + 1.0));
}

} // namespace dff
