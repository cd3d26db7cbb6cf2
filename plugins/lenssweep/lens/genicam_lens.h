/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_features.h"
#include "lens.h"
#include "optics/focus_points.h"

#include <optional>
#include <string>
#include <vector>

namespace dff {

/* A lens that the camera itself moves, by the features of GenICam's category OpticControl (SFNC 2.5 and
 * later). FocalPower takes the plan's dioptres, and any other feature, such as FocusStepper or a voltage,
 * what the points of a profile say; without a profile it is taken to be larger for nearer, and its whole
 * range holds the sweep, uncalibrated. Its safe state is where it is. */
class GenicamLens : public SteppedLens {
public:
    /* Throws LensError if the camera has no such feature. The camera outlives the lens. */
    GenicamLens(CameraFeatures &camera, std::string feature, std::optional<FocusPoints> points);

    void prepare(const LensSweep &sweep) override;

    /* Has the optics connected and initialised, where they must be; that may take seconds. */
    void start() override;
    void stop() override {}
    bool calibrated() const override;

    /* The value of an integer feature, else -1. */
    int code(unsigned plane) const override;
    void move_to(unsigned plane) override;

    /* Asks FocusStatus until it is no longer busy, where the camera has it. */
    bool wait_settled(const std::stop_token &stop) override;

private:
    enum class Readiness { Ready, Busy, NotConnected, Failed };

    Readiness readiness(const std::string &status);
    bool needs(const std::string &command, const std::string &status);
    bool wait_ready(const std::string &status, const std::stop_token &stop, bool connecting);

    double value_of(const SweepPlan &plan, unsigned plane, std::pair<double, double> range) const;
    [[noreturn]] void refuse(double value, std::pair<double, double> range);

    CameraFeatures &camera_;
    std::string feature_;
    std::optional<FocusPoints> points_;
    bool integer_;
    std::vector<double> values_; /* of the feature, one a plane */
};

} // namespace dff
