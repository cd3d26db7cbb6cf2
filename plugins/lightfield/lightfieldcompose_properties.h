/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "light_field_settings.h"

#include <gst/gst.h>

namespace dff {

/* The properties that say what to make; those of the element itself come after them. */
constexpr guint light_field_properties_end = 21;

void install_light_field_properties(GObjectClass *object_class);

/* False if there is no property of this id. */
bool set_light_field_property(LightFieldSettings &settings, guint id, const GValue *value);
bool get_light_field_property(const LightFieldSettings &settings, guint id, GValue *value);

} // namespace dff
