/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff-prelude.h>

G_BEGIN_DECLS

GST_DFF_API GstElement *gst_dff_capture_new(const gchar *launch, GError **error);
GST_DFF_API gboolean gst_dff_capture_check_caps(const gchar *output, const GstCaps *caps, GError **error);

G_END_DECLS
