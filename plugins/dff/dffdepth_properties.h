/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/focus_engine.h"

#include <gst/dff/dff.h>
#include <string>

namespace dff {

/* Whether depth is kept steady where nothing moves; auto: of live sources. */
enum class Steadiness { Auto, Off, On };

/* What a user can set on dffdepth. */
struct DepthSettings {
    DepthParameters parameters;
    GstDepthUnit unit = GST_DEPTH_UNIT_AUTO;
    Steadiness steady = Steadiness::Auto;
    std::string device;
    std::string calibration; /* file, or empty */
};

/* The properties of dffdepth, from 1 to depth_properties_end - 1. */
constexpr guint depth_properties_end = 17;

void install_depth_properties(GObjectClass *object_class);

/* False if `id` is not one of these properties. */
bool set_depth_property(DepthSettings &settings, guint id, const GValue *value);
bool get_depth_property(const DepthSettings &settings, guint id, GValue *value);

} // namespace dff
