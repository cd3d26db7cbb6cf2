/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/mux_core.h"

namespace dff {

/* The properties of focalstackmux that a user can set, from 1 to mux_properties_end - 1. */
constexpr guint mux_properties_end = 4;

void install_mux_properties(GObjectClass *object_class);

/* False if `id` is not one of these properties. */
bool set_mux_property(MuxSettings &settings, guint id, const GValue *value);
bool get_mux_property(const MuxSettings &settings, guint id, GValue *value);

} // namespace dff
