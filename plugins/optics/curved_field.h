/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "optics/depth_scale.h"
#include "optics/focus_calibration.h"

#include <cstddef>
#include <cstdint>

namespace dff {

/* Turns a depth map that knows nothing of the lens's field, in dioptres over the calibrated planes, into one
 * that does, in dioptres or millimetres. */
class CurvedField {
public:
    /* Throws std::invalid_argument for another unit. */
    CurvedField(const FocusCalibration &focus, unsigned width, unsigned height, DepthUnit unit);

    /* What the map's pixels mean after apply(): in dioptres from near() to far(), between which every place
     * of the picture has its planes. */
    DepthScale scale() const { return scale_; }
    double near() const { return near_; }
    double far() const { return far_; }

    /* Pixels without a value stay so. `stride` is in bytes. */
    void apply(std::byte *pixels, std::size_t stride) const;

    /* The same of standard deviations, by the depths that apply() gave. At least 1 where there are any. */
    void apply_to_deviations(std::byte *pixels, std::size_t stride, const std::byte *depths,
                             std::size_t depth_stride) const;

private:
    void to_dioptres(uint16_t *row, unsigned y) const;
    void to_millimetres(uint16_t *row, unsigned y) const;
    float field_at(float x, float y) const;

    FocusCalibration focus_;
    unsigned width_;
    unsigned height_;
    double near_;
    double far_;
    DepthScale scale_;
};

} // namespace dff
