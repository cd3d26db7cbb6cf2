/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens.h"
#include "optics/focus_points.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dff {

/* The least and the greatest position of a device's lens, nothing if there is none that can be set. */
std::optional<std::pair<int, int>> v4l2_focus_range(const std::string &device);

/* The lens of a V4L2 device: autofocus is switched off, and the control "focus, absolute" moved over its
 * whole range. The control is larger for nearer, in no unit, so planes are in order and uncalibrated, unless
 * the points of a profile say which position focuses where. Its
 * safe state is where it is, with autofocus as it was. The kernel does not tell when the lens rests. */
class V4l2Lens : public SteppedLens {
public:
    /* Throws LensError if the device is missing, or cannot be focused. */
    V4l2Lens(std::string device, std::optional<FocusPoints> points);
    ~V4l2Lens() override;

    void prepare(const LensSweep &sweep) override;
    void start() override;
    void stop() override;
    bool calibrated() const override { return points_.has_value(); }
    int code(unsigned plane) const override { return static_cast<int>(positions_.at(plane)); }
    void move_to(unsigned plane) override;
    bool wait_settled(const std::stop_token &stop) override { return !stop.stop_requested(); }
    bool knows_rest() const override { return false; }

private:
    bool set(std::uint32_t control, std::int32_t value);

    std::string device_;
    std::optional<FocusPoints> points_;
    int descriptor_;
    bool autofocus_ = false; /* whether it was on before start() */
    std::vector<double> positions_;
};

} // namespace dff
