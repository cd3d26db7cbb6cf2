/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "light_field_disparity.h"

#include <gst/gst.h>

namespace dff {

/* The fields "disparity" and "sharp-disparity" of messages and statistics. */
void add_disparity(GstStructure *structure, const LightFieldDisparity &disparity);

/* Tells it to the application by an element message, and warns of one that the display does not show sharply.
 */
void post_disparity(GstElement *element, const LightFieldDisparity &disparity);

} // namespace dff
