/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fuzz.h"
#include "rtp/rtphdrextdff.h"

#include <gst/dff/dff.h>

static GstRTPHeaderExtension *extension;

extern "C" int LLVMFuzzerInitialize(int *, char ***)
{
    gst_init(nullptr, nullptr);
    g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_WARNING));
    extension = GST_RTP_HEADER_EXTENSION(
        gst_object_ref_sink(g_object_new(GST_TYPE_RTP_HEADER_EXTENSION_DFF, nullptr)));
    gst_rtp_header_extension_set_id(extension, 1);
    return 0;
}

/* What the last packet of a frame brings; then a second packet that brings the same. */
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autoptr(GstBuffer) frame = gst_buffer_new();
    for (int packet = 0; packet < 2; packet++)
        dff::require(
            gst_rtp_header_extension_read(extension, GST_RTP_HEADER_EXTENSION_TWO_BYTE, data, size, frame));
    guint metas = 0;
    gpointer state = nullptr;
    while (gst_buffer_iterate_meta(frame, &state))
        metas++;
    dff::require(metas <= 2);
    return 0;
}
