/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/engine_error.h"

#include <gst/gst.h>

namespace dff {

/* Posts an engine's failure as an error, which ends the stream. */
void post_engine_error(GstElement *element, const EngineError &error);

/* Posts it as a warning; the stream goes on. */
void post_engine_warning(GstElement *element, const EngineError &error);

} // namespace dff
