/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gpio_lines.h"

namespace dff {

namespace {

constexpr const char *missing =
    "this build has no GPIO lines: install libgpiod-dev (1.6 or 2) and build again";

} // namespace

std::unique_ptr<OutputLine> open_gpio_output_line(const std::string &)
{
    throw LineError(missing);
}

std::unique_ptr<EdgeLine> open_gpio_edge_line(const std::string &)
{
    throw LineError(missing);
}

} // namespace dff
