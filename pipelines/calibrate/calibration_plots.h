/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "rig_calibration.h"

namespace dff {

/* Draws as SVG where the boards' corners lie and how far focus is off there, the vergence of each plane, what
 * is left of focus over the planes, how bright the planes are, and the noise. Throws std::runtime_error with
 * a user's text. */
void write_plots(const std::string &path, const RigCalibration &calibration);

} // namespace dff
