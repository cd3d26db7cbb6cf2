/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fuzz.h"
#include "optics/camera_calibration.h"
#include "optics/focus_calibration.h"

#include <algorithm>
#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dff::read_as_file(data, size, [](const std::string &path) {
        if (const auto focus = dff::read_focus_calibration(path))
            dff::require(focus->vergences.size() >= 2 && focus->vergences.front() > focus->vergences.back());
        const dff::CameraCalibration camera = dff::read_camera_calibration(path).scaled_to(8192, 64);
        dff::require(camera.fx > 0.0 && camera.fy > 0.0 && std::isfinite(camera.fx * camera.fy));
        dff::require(std::isfinite(camera.cx) && std::isfinite(camera.cy));
        dff::require(std::ranges::all_of(camera.distortion, [](double k) { return std::isfinite(k); }));
    });
    return 0;
}
