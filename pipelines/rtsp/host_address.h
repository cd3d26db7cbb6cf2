/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <string>

namespace dff {

/* The host of a URL at which a server that is bound to `address` can be reached. For all addresses of this
 * machine, that is the first which other machines can reach, or localhost if there is none. */
std::string host_in_url(const std::string &address);

} // namespace dff
