/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_parameters.h"

#include <span>
#include <string>

namespace dff {

/* What the maker of a display asks of its quilts. */
struct DisplayPreset {
    const char *nick;
    const char *name;
    unsigned columns;
    unsigned rows;
    double aspect; /* width by height of the display */
    PictureSize quilt;
};

/* From the table "Quilt Settings by Device" of https://docs.lookingglassfactory.com/keyconcepts/quilts; the
 * aspects are those of the panels. */
std::span<const DisplayPreset> display_presets();

/* The end of a quilt's file name, before the dot, by which players know it: "_qs8x6a0.75" for 8 columns, 6
 * rows and views 0.75 as wide as high. */
std::string quilt_suffix(unsigned columns, unsigned rows, double aspect);

} // namespace dff
