/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_geometry.h"
#include "fuzz.h"
#include "lightfield/light_field_settings.h"

#include <cmath>

/* The sizes that lightfieldcompose allocates and the places that it looks up, as the file makes them. */
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dff::read_as_file(data, size, [](const std::string &path) {
        dff::LightFieldSettings settings;
        settings.parameters.layout = dff::LightFieldLayout::Lenticular;
        settings.calibration = path;
        const dff::PictureSize picture{1920, 1080};
        const dff::LightFieldPlan plan(settings, picture);
        const dff::PictureSize panel = plan.output;
        dff::require(panel.width >= 1 && panel.width <= dff::largest_output_side);
        dff::require(panel.height >= 1 && panel.height <= dff::largest_output_side);

        const dff::LenticularSheet &sheet = plan.parameters.sheet;
        const double lenses = sheet.pitch * (1.0 + std::abs(sheet.tilt)) + std::abs(sheet.center);
        dff::require(lenses < 1e6); /* counted in single precision */
        const dff::LightFieldGeometry geometry(plan.parameters, picture, panel);
        dff::require(geometry.columns().count > 0 && geometry.columns().count < 1 << 20);
        dff::require(geometry.layers.x >= 1 && geometry.layers.y >= 1);
    });
    return 0;
}
