/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <map>
#include <string_view>

namespace dff {

/* The files of kernels/ by their names without the ending. */
const std::map<std::string_view, std::string_view> &kernel_sources();

} // namespace dff
