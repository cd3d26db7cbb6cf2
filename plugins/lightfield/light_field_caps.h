/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "light_field_settings.h"

#include <gst/video/video.h>

#define DFF_RGB_FORMATS "RGBx, BGRx, RGB, BGR"

namespace dff {

/* What the plan makes of the colour's caps, in any format of RGB; first that of the colour, if it is one. */
GstCaps *light_field_caps(const GstVideoInfo &color, const LightFieldPlan &plan);

/* The size nearest to the plan's, and for two views how they are packed. Takes the caps. */
GstCaps *fixate_light_field_caps(GstCaps *caps, const LightFieldPlan &plan);

} // namespace dff
