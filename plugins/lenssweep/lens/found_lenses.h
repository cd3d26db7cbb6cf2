/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dff {

/* A lens on this machine that tells of itself. Those on an I2C bus do not. */
struct FoundLens {
    enum class Kind { Camera, Subdevice, Driver };
    Kind kind;
    std::string device; /* "/dev/video0" */
    std::string name;   /* of the camera, the lens chip or the driver */
    std::string what;   /* "focus 0 to 255" */
    std::string uri;    /* for the property lens */
};

/* Where to look, which is elsewhere in tests. */
struct Machine {
    using FocusRange = std::function<std::optional<std::pair<int, int>>(const std::string &device)>;

    std::string sysfs = "/sys";
    FocusRange focus_range; /* of a V4L2 device, if its focus can be set; opens it */
};

/* This machine. */
Machine this_machine();

/* V4L2 cameras and sub-devices whose focus can be set, and Lens Drivers of Optotune on the USB. None of them
 * is moved. */
std::vector<FoundLens> find_lenses(const Machine &machine);

/* For the end of an error's text: "Found on this machine: /dev/video0 (Webcam): focus 0 to 255,
 * lens=v4l2:...". */
std::string describe(const std::vector<FoundLens> &lenses);

} // namespace dff
