/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

namespace dff {

/* The server's debug category, dff-rtsp-server. Needs gst_init. */
inline GstDebugCategory *server_log()
{
    static GstDebugCategory *const category = [] {
        GstDebugCategory *made = nullptr;
        GST_DEBUG_CATEGORY_INIT(made, "dff-rtsp-server", 0, "depth and all-in-focus video by RTSP");
        return made;
    }();
    return category;
}

} // namespace dff

#define GST_CAT_DEFAULT dff::server_log()
