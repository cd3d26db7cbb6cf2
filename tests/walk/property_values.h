/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "chance.h"

#include <gst/gst.h>
#include <string>
#include <vector>

namespace dff::walk {

/* The properties that an element of ours brings itself: those of its base classes are tested elsewhere. */
std::vector<GParamSpec *> own_properties(GstElement *element);

/* Whether the property says that it may be set in this state. */
bool may_be_set(const GParamSpec *property, GstState state);

/* Sets the property to its least, its greatest, its default or some other value that its type allows, and
 * returns "name=value". Empty for types that cannot be set by a user's text. */
std::string set_some_value(GstElement *element, GParamSpec *property, Chance &chance);

} // namespace dff::walk
