/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_parameters.h"

#include <string>

namespace dff {

/* How the lenses of one display lie over its panel. */
struct DisplayCalibration {
    LenticularSheet sheet;
    PictureSize panel;
    double view_cone; /* radians; 0 if the file does not say */

    /* Reads a file (optics/settings_file.h) with the fields of Looking Glass displays, each a number or a map
     * with a number in `value`: screenW and screenH (pixels), DPI (pixels an inch), pitch (lenses an inch
     * across them), slope (of the lenses: rise by run), center; and if they are there invView, flipImageX,
     * flipImageY, flipSubp (0 or 1), viewCone (degrees),
     * and of panels whose colours are not beside each other subpixelCells (a list of ROffsetX, ROffsetY,
     * GOffsetX
     * ... in pixels to the right and up) with CellPatternMode (0 to 4, see CellPattern).
     *
     * pitch = pitch screenW / DPI cos(atan(1 / slope)) lenses along the width,
     * tilt = screenH / (screenW slope), negative if flipImageX.
     *
     * Throws std::runtime_error with a user's text. */
    static DisplayCalibration load(const std::string &path);
};

} // namespace dff
