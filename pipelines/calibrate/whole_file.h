/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <string>

namespace dff {

/* Writes a file that is there whole or not at all: what was there before stays until then. `what` it is, for
 * the user; throws std::runtime_error. */
void write_whole_file(const std::string &what, const std::string &path, const std::string &text);

} // namespace dff
