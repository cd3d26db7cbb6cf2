/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>

#include <string>

namespace dff {

#define FOCAL_STACK_FRAME_CAPS                                                                               \
    "video/x-raw, format = (string) " GST_FOCAL_STACK_FORMATS ", " GST_FOCAL_STACK_SIZES                     \
    ", framerate = (fraction) [ 0, max ]"

/* Which frames make such stacks, and which stacks such frames make: the same format and size at any rate. */
GstCaps *frame_caps_from_stack_caps(const GstCaps *caps);
GstCaps *stack_caps_from_frame_caps(const GstCaps *caps);

/* What the peer of `other` allows, turned around by `convert`, and the template of `pad` too. */
GstCaps *caps_through(GstPad *pad, GstPad *other, GstCaps *(*convert)(const GstCaps *));

enum class Sizes {
    AsTheyAre,
    AnyInNeed, /* what is asked for and of a wrong size only is answered all the same: not-negotiated would
                  come of it upstream, where nobody knows why, and here the CAPS event can be refused in words
                */
};

/* Answers the CAPS query of `pad` with caps_through(). */
void answer_caps_query(GstQuery *query, GstPad *pad, GstPad *other, GstCaps *(*convert)(const GstCaps *),
                       Sizes sizes);

/* "64x64", or "64x64 to 16384x16384", of the first structure. */
std::string describe_sizes(const GstCaps *caps);

} // namespace dff
