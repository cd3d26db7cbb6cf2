/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "../gstfocusmeta.h"

#include <gst/base/gstbytereader.h>
#include <gst/base/gstbytewriter.h>

G_BEGIN_DECLS

void gst_focus_info_write(const GstFocusInfo *info, GstByteWriter *writer);
gboolean gst_focus_info_read(GstFocusInfo *info, GstByteReader *reader);

G_END_DECLS
