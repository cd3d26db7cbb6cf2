/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lines.h"

namespace dff {

/* Lines of a GPIO chip, called by name or by chip and offset. Throw LineError; always, in a build without
 * libgpiod. */
std::unique_ptr<OutputLine> open_gpio_output_line(const std::string &name);
std::unique_ptr<EdgeLine> open_gpio_edge_line(const std::string &name);

} // namespace dff
