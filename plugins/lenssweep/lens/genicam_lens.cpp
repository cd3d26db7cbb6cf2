/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "genicam_lens.h"

#include "interruptible_sleep.h"
#include "uncalibrated_positions.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace dff {

namespace {

constexpr std::chrono::milliseconds poll_interval{2};
constexpr std::chrono::seconds longest_move{5};

constexpr const char *calibrated_feature = "FocalPower";
constexpr const char *selector = "OpticControllerSelector";
constexpr const char *focus_status = "FocusStatus";

/* What makes optics ready, in this order, and what tells that they are. The first two are makers' own, the
 * others the SFNC's; FocusInitialize is there only if it is needed beside OpticControllerInitialize. */
struct Preparation {
    const char *command;
    const char *status;
};
constexpr Preparation preparations[] = {{"LensConnection", "LensStatus"},
                                        {"LensConnect", "LensStatus"},
                                        {"OpticControllerInitialize", "OpticControllerStatus"},
                                        {"FocusInitialize", focus_status}};

/* What the camera throws becomes an error of the lens. */
template <typename Access> auto access(Access use)
{
    try {
        return use();
    } catch (const LensError &) {
        throw;
    } catch (const std::runtime_error &error) {
        throw LensError(std::string("the lens in the camera cannot be moved: ") + error.what());
    }
}

} // namespace

GenicamLens::GenicamLens(CameraFeatures &camera, std::string feature, std::optional<FocusPoints> points)
    : camera_(camera), feature_(std::move(feature)), points_(std::move(points))
{
    access([this] {
        if (camera_.has(selector)) {
            /* A camera has one lens; what else is selected here is left over from another program. */
            camera_.set_enumeration(selector, camera_.enumeration_values(selector).at(0));
        }
        if (!camera_.has(feature_)) {
            throw LensError("the camera has no feature " + feature_ +
                            " to focus by. Look for its category OpticControl with arv-tool-0.8 features");
        }
        integer_ = camera_.is_integer(feature_);
    });
}

bool GenicamLens::calibrated() const
{
    return points_ || feature_ == calibrated_feature;
}

double GenicamLens::value_of(const SweepPlan &plan, unsigned plane, std::pair<double, double> range) const
{
    double value = 0;
    if (points_)
        value = points_->position(plan.power(plane));
    else if (calibrated())
        value = plan.power(plane);
    else
        value = std::lerp(range.first, range.second, relative_nearness(plan, plane));
    return integer_ ? std::round(value) : value;
}

void GenicamLens::refuse(double value, std::pair<double, double> range)
{
    const std::string unit = access([this] { return camera_.unit(feature_); });
    std::ostringstream text;
    text << feature_ << " of the camera is " << range.first << " to " << range.second
         << (unit.empty() ? "" : " " + unit) << ", not " << value
         << (points_ ? ": the lens profile is of another lens" : ": set near and far");
    throw std::invalid_argument(text.str());
}

void GenicamLens::prepare(const LensSweep &sweep)
{
    const auto range = access([this]() -> std::pair<double, double> {
        if (integer_) {
            return camera_.integer_range(feature_);
        }
        return camera_.float_range(feature_);
    });
    std::vector<double> values;
    for (unsigned plane = 0; plane < sweep.plan.planes(); ++plane) {
        values.push_back(value_of(sweep.plan, plane, range));
        if (values.back() < range.first || values.back() > range.second)
            refuse(values.back(), range);
    }
    require_different(values);
    values_ = std::move(values);
}

GenicamLens::Readiness GenicamLens::readiness(const std::string &status)
{
    const std::string value = access([&] { return camera_.get_enumeration(status); });
    if (value == "Ready" || value == "NotBusy" || value == "Idle") {
        return Readiness::Ready;
    }
    if (value == "NotConnected") {
        return Readiness::NotConnected;
    }
    return value == "Error" ? Readiness::Failed : Readiness::Busy;
}

/* `connecting`: a lens that is not connected may be so in a moment. */
bool GenicamLens::wait_ready(const std::string &status, const std::stop_token &stop, bool connecting)
{
    if (!access([&] { return camera_.has(status); })) {
        return !stop.stop_requested();
    }
    const auto deadline = std::chrono::steady_clock::now() + longest_move;
    for (;;) {
        const auto now = readiness(status);
        if (now == Readiness::Ready) {
            return !stop.stop_requested();
        }
        const bool failed = now == Readiness::Failed || (now == Readiness::NotConnected && !connecting);
        if (failed || std::chrono::steady_clock::now() >= deadline) {
            throw LensError("the lens in the camera " +
                            std::string(failed ? "has failed" : "does not come to rest") + ": " + status +
                            " is " + access([&] { return camera_.get_enumeration(status); }));
        }
        if (!sleep_until(std::chrono::steady_clock::now() + poll_interval, stop)) {
            return false;
        }
    }
}

bool GenicamLens::needs(const std::string &command, const std::string &status)
{
    return access([&] { return camera_.is_command(command); }) &&
           !(access([&] { return camera_.has(status); }) && readiness(status) == Readiness::Ready);
}

/* Connects, then initialises what says that it is not. */
void GenicamLens::start()
{
    for (const Preparation &step : preparations) {
        if (needs(step.command, step.status)) {
            access([&] { camera_.execute(step.command); });
            wait_ready(step.status, {}, true);
        }
    }
}

int GenicamLens::code(unsigned plane) const
{
    return integer_ ? static_cast<int>(values_.at(plane)) : -1;
}

void GenicamLens::move_to(unsigned plane)
{
    const double value = values_.at(plane);
    access([&] {
        if (integer_) {
            camera_.set_integer(feature_, static_cast<std::int64_t>(value));
        } else {
            camera_.set_float(feature_, value);
        }
    });
}

bool GenicamLens::wait_settled(const std::stop_token &stop)
{
    return wait_ready(focus_status, stop, false);
}

} // namespace dff
