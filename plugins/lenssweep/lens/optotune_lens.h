/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens.h"
#include "optics/focus_points.h"
#include "optotune_driver.h"

#include <chrono>
#include <optional>
#include <vector>

namespace dff {

/* A tunable lens of Optotune behind its Lens Driver 4 or 4i. Without a profile the plan's vergences are the
 * focal powers that the driver holds, which is so if the camera sees infinity sharply at 0 dioptres of the
 * lens. The points of a profile give other focal powers, or, with unit "mA", currents. Its safe state is
 * without current. */
class OptotuneLens : public SteppedLens {
public:
    /* Throws LensError if no driver answers on the port, std::invalid_argument for points in another unit. */
    OptotuneLens(const std::string &device, std::optional<FocusPoints> points);
    ~OptotuneLens() override;

    void prepare(const LensSweep &sweep) override;
    void start() override {}
    void stop() override;
    bool calibrated() const override { return true; }
    int code(unsigned plane) const override;

    /* Throws LensError if the lens is too hot, which is looked at once a sweep. */
    void move_to(unsigned plane) override;

    /* Waits as long as their slowest lens takes. */
    bool wait_settled(const std::stop_token &stop) override;

private:
    OptotuneDriver::Range enter_mode();

    OptotuneDriver driver_;
    std::optional<FocusPoints> points_;
    bool by_current_;
    std::vector<double> positions_; /* dioptres or mA, one a plane */
    std::chrono::steady_clock::time_point settled_at_;
};

} // namespace dff
