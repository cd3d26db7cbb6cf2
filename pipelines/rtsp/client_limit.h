/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/rtsp-server/rtsp-server.h>

namespace dff {

/* Lets the server serve so many clients at a time, 1 to most_clients of server_options.h; one more is
 * answered 503 Service Unavailable. A client is one that has set a stream up, and counts until its connection
 * ends. */
void limit_clients(GstRTSPServer *server, unsigned max_clients);

} // namespace dff
