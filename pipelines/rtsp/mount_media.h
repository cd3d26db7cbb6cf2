/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "capture.h"
#include "mount.h"

#include <gst/rtsp-server/rtsp-server.h>

namespace dff {

/* Makes the media of a mount: one for all its clients, whatever stands behind the path of the URL. With
 * `tcp_only`, clients may not ask for UDP. `mount` outlives it. */
ObjectPointer<GstRTSPMediaFactory> make_factory(const Mount &mount, std::shared_ptr<Capture> capture,
                                                bool tcp_only);

} // namespace dff
