/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "rig_calibration.h"

namespace dff {

/* Writes what every `calibration` property takes: the camera as OpenCV's calibration sample has it, the
 * planes' warps as focalstackalign has them, and `focus`. Throws std::runtime_error with a user's text; a
 * file that was there before is then as it was. */
void write_calibration(const std::string &file, const RigCalibration &calibration, const Board &board);

/* Of a file that write_calibration() wrote. Throws as it does. */
RigCalibration read_calibration(const std::string &file);

} // namespace dff
