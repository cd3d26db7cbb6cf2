/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "gst_pointer.h"
#include "server_options.h"

#include <gst/rtsp-server/rtsp-server.h>

namespace dff {

/* The role that may look at the mounts. */
inline constexpr const char *viewer_role = "viewer";

/* Who may connect, and how: the accounts by digest, and by basic where options.basic or a certificate allows
 * it. Null if anyone may, unencrypted. Throws std::invalid_argument, with a text for the user, if the
 * certificate or its key cannot be read. */
ObjectPointer<GstRTSPAuth> make_auth(const ServerOptions &options);

/* Lets viewers, and nobody else, look at what the factory makes. */
void restrict_to_viewers(GstRTSPMediaFactory *factory);

} // namespace dff
