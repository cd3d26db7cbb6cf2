/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstaggregator.h>

G_BEGIN_DECLS

#define GST_TYPE_AIF_COMPOSE (gst_aif_compose_get_type())
G_DECLARE_FINAL_TYPE(GstAifCompose, gst_aif_compose, GST, AIF_COMPOSE, GstAggregator)

GST_ELEMENT_REGISTER_DECLARE(aifcompose)

G_END_DECLS
