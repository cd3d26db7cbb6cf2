/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_control.h"

#include "optics/sweep_plan.h"

#include <optional>
#include <string>

namespace dff {

/* Who tells the camera to expose. */
enum class TriggerKind {
    Line,     /* a pulse on a line of the camera */
    Software, /* a command of the host's */
    FreeRun   /* the camera itself, at its frame rate */
};

struct TriggerSetup {
    TriggerKind kind = TriggerKind::Line;
    std::string source = "Line0"; /* of TriggerKind::Line */
    double frame_rate = 0;        /* frames a second; only a free-running camera is told */
};

/* Makes the camera expose one frame at each trigger, timed, and takes overlapping exposure and readout where
 * the camera can, since it would miss every second trigger without. What a camera does not have is left
 * alone. Throws CameraError, with the list of what the camera has, for a source that it has not. */
void set_up_trigger(CameraControl &camera, const TriggerSetup &setup);

/* Of a free-running camera, in frames a second. */
void set_frame_rate(CameraControl &camera, double frame_rate);

/* Microseconds, by ExposureTime or, of older cameras, ExposureTimeAbs. Throws CameraError, with the range,
 * for one that the camera cannot do. */
void set_exposure(CameraControl &camera, double exposure_us);

/* In the unit of the camera's Gain or GainRaw, mostly dB. Throws CameraError, with the range. */
void set_gain(CameraControl &camera, double gain);

/* Whether the camera waits for a trigger now, as far as it says so. */
bool trigger_armed(CameraControl &camera);

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
    std::string calibration; /* file that says where the planes are sharp */

    double frame_rate() const { return rate * plan.planes(); }
};

} // namespace dff
