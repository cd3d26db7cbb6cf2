/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/depth_scale.h"

#include <optional>

namespace dff {

/* Where the pixels of a depth map lie between near (position 0) and far (position 1): evenly in dioptres in
 * the units dioptre and millimetre, evenly in pixels in the units index and micrometre. */
class DepthRange {
public:
    /* `near` and `far` in dioptres; if they are not given, those that the scale itself can say. Throws
     * std::invalid_argument with a user's text if they are needed and unknown, or in the wrong order. */
    DepthRange(DepthScale scale, std::optional<double> near, std::optional<double> far);

    /* Clamped to [0, 1]; empty for DepthScale::no_value. */
    std::optional<double> position(uint16_t pixel) const;

    /* The pixel of a position in [0, 1]; never DepthScale::no_value. */
    uint16_t pixel(double position) const;

    bool operator==(const DepthRange &) const = default;

private:
    bool in_dioptres() const { return unit_ == DepthUnit::Dioptre || unit_ == DepthUnit::Millimetre; }

    DepthUnit unit_;
    double scale_;
    double offset_;
    double near_ = 0.0;
    double far_ = 0.0;
};

/* The scale of maps in dioptres between `near` and `far`: pixel = 1 + round(65534 (near - d) / (near - far)).
 */
DepthScale dioptre_scale(double near, double far);

} // namespace dff
