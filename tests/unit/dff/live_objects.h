/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace dff {

/* How many objects of each type are alive, as the leaks tracer counts them (GST_TRACERS=leaks). */
std::map<std::string, unsigned> live_objects();

/* What is alive beyond `before`. Streaming threads let go of their last objects a moment after the state
 * change, hence the patience. */
std::map<std::string, unsigned> left_behind(const std::map<std::string, unsigned> &before);

/* Memory of this process that is in use. */
size_t resident_kib();

/* Under the address sanitizer memory grows, since it keeps what is freed for a while, and its search for
 * leaks would report the tracer's own list. */
bool is_sanitized();

} // namespace dff
