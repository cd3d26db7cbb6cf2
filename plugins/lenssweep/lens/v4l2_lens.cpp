/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "v4l2_lens.h"

#include "uncalibrated_positions.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sstream>
#include <stdexcept>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>

namespace dff {

namespace {

std::string reason()
{
    return std::generic_category().message(errno);
}

template <typename Request> bool control(int descriptor, unsigned long number, Request &request)
{
    int result = 0;
    do {
        result = ioctl(descriptor, number, &request);
    } while (result < 0 && errno == EINTR);
    return result == 0;
}

bool query(int descriptor, std::uint32_t id, v4l2_queryctrl &found)
{
    found = {};
    found.id = id;
    return control(descriptor, VIDIOC_QUERYCTRL, found) && !(found.flags & V4L2_CTRL_FLAG_DISABLED);
}

/* The nearest position that the control has; its steps begin at its minimum. */
double stepped(const v4l2_queryctrl &focus, double position)
{
    const int step = std::max(focus.step, 1);
    const double nearest = focus.minimum + step * std::floor((position - focus.minimum) / step + 0.5);
    return nearest > focus.maximum ? nearest - step : nearest;
}

double relative_position(const v4l2_queryctrl &focus, double nearness)
{
    return stepped(focus, focus.minimum + nearness * (focus.maximum - focus.minimum));
}

double measured_position(const v4l2_queryctrl &focus, double position)
{
    if (!(position >= focus.minimum && position <= focus.maximum)) {
        std::ostringstream text;
        text << "focus_absolute is " << focus.minimum << " to " << focus.maximum << ", not " << position
             << ": the lens profile is of another lens";
        throw std::invalid_argument(text.str());
    }
    return stepped(focus, position);
}

} // namespace

std::optional<std::pair<int, int>> v4l2_focus_range(const std::string &device)
{
    const int descriptor = open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return std::nullopt;
    v4l2_queryctrl focus{};
    const bool can = query(descriptor, V4L2_CID_FOCUS_ABSOLUTE, focus);
    close(descriptor);
    return can ? std::optional(std::pair(focus.minimum, focus.maximum)) : std::nullopt;
}

V4l2Lens::V4l2Lens(std::string device, std::optional<FocusPoints> points)
    : device_(std::move(device)), points_(std::move(points)),
      descriptor_(open(device_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC))
{
    if (descriptor_ < 0) {
        throw LensError("cannot open the lens " + device_ + ": " + reason() +
                        ". v4l2-ctl --list-devices lists those there are");
    }
    v4l2_queryctrl focus{};
    if (!query(descriptor_, V4L2_CID_FOCUS_ABSOLUTE, focus)) {
        close(descriptor_);
        throw LensError(
            device_ +
            " has no control focus_absolute, so its lens cannot be moved. v4l2-ctl "
            "--list-ctrls lists its controls; a sensor's lens is often a /dev/v4l-subdev of its own");
    }
}

V4l2Lens::~V4l2Lens()
{
    if (autofocus_) {
        set(V4L2_CID_FOCUS_AUTO, 1);
    }
    close(descriptor_);
}

bool V4l2Lens::set(std::uint32_t id, std::int32_t value)
{
    v4l2_control request{id, value};
    return control(descriptor_, VIDIOC_S_CTRL, request);
}

void V4l2Lens::prepare(const LensSweep &sweep)
{
    v4l2_queryctrl focus{};
    if (!query(descriptor_, V4L2_CID_FOCUS_ABSOLUTE, focus)) {
        throw LensError("cannot ask " + device_ + " for the range of focus_absolute: " + reason());
    }
    std::vector<double> positions;
    for (unsigned plane = 0; plane < sweep.plan.planes(); ++plane)
        positions.push_back(points_ ? measured_position(focus, points_->position(sweep.plan.power(plane)))
                                    : relative_position(focus, relative_nearness(sweep.plan, plane)));
    require_different(positions);
    positions_ = std::move(positions);
}

void V4l2Lens::start()
{
    v4l2_queryctrl known{};
    if (!query(descriptor_, V4L2_CID_FOCUS_AUTO, known)) {
        return;
    }
    v4l2_control now{V4L2_CID_FOCUS_AUTO, 0};
    autofocus_ = autofocus_ || (control(descriptor_, VIDIOC_G_CTRL, now) && now.value != 0);
    if (!set(V4L2_CID_FOCUS_AUTO, 0)) {
        throw LensError("cannot switch the autofocus of " + device_ + " off: " + reason());
    }
}

void V4l2Lens::stop()
{
    if (autofocus_ && !set(V4L2_CID_FOCUS_AUTO, 1)) {
        throw LensError("cannot switch the autofocus of " + device_ + " on again: " + reason());
    }
    autofocus_ = false;
}

void V4l2Lens::move_to(unsigned plane)
{
    if (!set(V4L2_CID_FOCUS_ABSOLUTE, static_cast<std::int32_t>(positions_.at(plane)))) {
        throw LensError(errno == ENODEV ? device_ + " was unplugged in mid-sweep"
                                        : "cannot move the lens of " + device_ + ": " + reason());
    }
}

} // namespace dff
