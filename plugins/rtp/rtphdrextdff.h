/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/rtp/rtp.h>

G_BEGIN_DECLS

/* The URI that an SDP names the extension by. */
#define GST_RTP_HEADER_EXTENSION_DFF_URI "urn:gst-plugins-dff:rtp-hdrext:metas"

#define GST_TYPE_RTP_HEADER_EXTENSION_DFF (gst_rtp_header_extension_dff_get_type())
G_DECLARE_FINAL_TYPE(GstRTPHeaderExtensionDff, gst_rtp_header_extension_dff, GST, RTP_HEADER_EXTENSION_DFF,
                     GstRTPHeaderExtension)

GST_ELEMENT_REGISTER_DECLARE(rtphdrextdff)

G_END_DECLS
