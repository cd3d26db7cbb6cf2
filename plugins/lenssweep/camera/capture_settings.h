/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_setup.h"

#include "optics/sweep_plan.h"

#include <optional>
#include <string>

namespace dff {

/* What a user asks of a swept camera. */
struct CaptureSettings {
    std::string camera;
    SweepPlan plan = SweepPlan::even(6, 5.0, 0.0);
    double rate = 26; /* sweeps a second */
    double exposure_us = 6000;
    std::optional<double> gain; /* as the camera has it if empty */
    TriggerKind trigger = TriggerKind::Line;
    std::string trigger_source = "Line0";
    std::string lens = "none";
    std::string lens_profile;
    std::string run_line;
    std::string sync_line;
    std::string features;

    double frame_rate() const { return rate * plan.planes(); }
};

} // namespace dff
