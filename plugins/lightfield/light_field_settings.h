/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_parameters.h"

#include <optional>
#include <string>

namespace dff {

inline constexpr uint32_t largest_picture_side = 8192; /* pixels, of what comes in */

/* Of the picture that a display is given: pixels a side. With 4 bytes a pixel, that is 1 GiB. */
inline constexpr uint32_t largest_output_side = 16384;
inline constexpr double largest_view_cone = 120.0; /* degrees */

/* What the user asks of lightfieldcompose. */
struct LightFieldSettings {
    LightFieldSettings() { parameters.columns = parameters.rows = 0; }

    LightFieldParameters parameters;     /* but for what stands below; columns and rows of 0: by layout */
    double view_cone = 0.0;              /* degrees; 0: the calibration's, else 40 */
    double zero_parallax_dioptre = -1.0; /* below 0: zero_parallax of the parameters holds */
    size_t preset = 0;                   /* of display_presets(), counted from 1; 0: none */
    PictureSize quilt{0, 0};             /* the preset's, if there is one */
    std::string calibration;             /* path of a file, or empty */
};

/* The parameters as they are meant, for pictures of this size. `lenticular` reads its calibration: throws
 * std::runtime_error with a user's text. */
struct LightFieldPlan {
    LightFieldPlan(const LightFieldSettings &settings, PictureSize picture);

    LightFieldParameters parameters;
    PictureSize output;    /* the size that suits best */
    bool any_size = false; /* other sizes of the output do, too */
};

} // namespace dff
