/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>

namespace dff {

#define FOCAL_STACK_FRAME_CAPS                                                                               \
    "video/x-raw, format = (string) " GST_FOCAL_STACK_FORMATS                                                \
    ", width = (int) [ 1, 8192 ], height = (int) [ 1, 8192 ], framerate = (fraction) [ 0, max ]"

/* Which frames make such stacks, and which stacks such frames make: the same format and size at any rate. */
GstCaps *frame_caps_from_stack_caps(const GstCaps *caps);
GstCaps *stack_caps_from_frame_caps(const GstCaps *caps);

/* Answers the CAPS query of `pad` with what the peer of `other` allows, turned around by `convert`. */
void answer_caps_query(GstQuery *query, GstPad *pad, GstPad *other, GstCaps *(*convert)(const GstCaps *));

} // namespace dff
