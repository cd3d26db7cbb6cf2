/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "calibrated_powers.h"

#include "optics/focus_calibration.h"

#include <stdexcept>

std::vector<double> calibrated_powers(const std::string &file, unsigned planes)
{
    if (file.empty())
        return {};
    const auto focus = dff::read_focus_calibration(file);
    if (!focus)
        throw std::invalid_argument("the calibration " + file +
                                    " does not say where planes are sharp; make one with dff-calibrate");
    if (focus->vergences.size() != planes)
        throw std::invalid_argument("the calibration " + file + " has " +
                                    std::to_string(focus->vergences.size()) + " planes and the sweep " +
                                    std::to_string(planes) + ": set planes");
    return focus->vergences;
}
