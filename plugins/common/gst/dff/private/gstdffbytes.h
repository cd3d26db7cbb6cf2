/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstbytereader.h>
#include <gst/base/gstbytewriter.h>
#include <gst/gst.h>

G_BEGIN_DECLS

/* The bytes of a meta: a letter for its kind, a version, then its fields, big endian. A reader refuses what
 * it does not know: versions other than its own, and bytes behind the last field. */
#define GST_DFF_BYTES_VERSION 1

void gst_dff_bytes_begin(GstByteWriter *writer, guint8 kind);
GBytes *gst_dff_bytes_end(GstByteWriter *writer);
gboolean gst_dff_bytes_open(GstByteReader *reader, GBytes *bytes, guint8 kind, GError **error);
gboolean gst_dff_bytes_close(const GstByteReader *reader, gboolean complete, GError **error);

#if GST_CHECK_VERSION(1, 24, 0)
/* A meta's serialize function: appends `bytes`, which it takes. */
gboolean gst_dff_bytes_append(GBytes *bytes, GstByteArrayInterface *data, guint8 *version);
#endif

G_END_DECLS
