/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gpio_lines.h"
#include "socket_lines.h"

#include <string_view>

namespace dff {

namespace {

constexpr std::string_view socket_prefix = "socket:";

} // namespace

std::unique_ptr<OutputLine> open_output_line(const std::string &name)
{
    return name.starts_with(socket_prefix) ? open_socket_output_line(name.substr(socket_prefix.size()))
                                           : open_gpio_output_line(name);
}

std::unique_ptr<EdgeLine> open_edge_line(const std::string &name)
{
    return name.starts_with(socket_prefix) ? open_socket_edge_line(name.substr(socket_prefix.size()))
                                           : open_gpio_edge_line(name);
}

} // namespace dff
