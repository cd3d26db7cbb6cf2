/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstaggregator.h>

G_BEGIN_DECLS

#define GST_TYPE_LIGHT_FIELD_COMPOSE (gst_light_field_compose_get_type())
G_DECLARE_FINAL_TYPE(GstLightFieldCompose, gst_light_field_compose, GST, LIGHT_FIELD_COMPOSE, GstAggregator)

GST_ELEMENT_REGISTER_DECLARE(lightfieldcompose)

G_END_DECLS
