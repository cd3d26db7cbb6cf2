/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <glib-object.h>
#include <optional>
#include <string>

namespace dff {

/* GLib does not set a property to a value out of its range: it warns in words of its own, and the element
 * runs with what it had. A property made of a spec that went through here takes every value, and its element
 * looks with value_out_of_range() when it starts. For specs of uint, int and double. */
GParamSpec *checked_at_start(GParamSpec *spec);

/* The first checked property of the object whose value is out of its range, as an error's text. */
std::optional<std::string> value_out_of_range(GObject *object);

} // namespace dff
