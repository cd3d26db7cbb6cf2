/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lines.h"

namespace dff {

/* Lines to another process, for rigs without GPIO: a Unix socket of packets (SOCK_SEQPACKET) at a path, on
 * which the other process listens. A packet is an edge: the text "LEVEL TIME", LEVEL 0 or 1, TIME in
 * nanoseconds of CLOCK_MONOTONIC. Whoever lets go of the socket pulls the line low. Throw LineError. */
std::unique_ptr<OutputLine> open_socket_output_line(const std::string &path);
std::unique_ptr<EdgeLine> open_socket_edge_line(const std::string &path);

} // namespace dff
