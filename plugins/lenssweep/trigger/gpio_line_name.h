/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lines.h"

namespace dff {

/* Who has the line, as gpioinfo shows it. */
constexpr const char *gpio_consumer = "gst-plugins-dff";

/* A line of a chip: "gpiochip0:5". */
struct GpioPlace {
    std::string chip;
    unsigned offset;
};

/* Empty where `name` has no colon and is the line's own. Throws LineError if there is no number behind it. */
std::optional<GpioPlace> gpio_place(const std::string &name);

/* What the system said last, errno, in words for the user. */
std::string system_reason();
LineError no_gpio_line(const std::string &name);
LineError cannot_open_gpio_line(const std::string &name);
LineError gpio_line_refused(const std::string &name, const std::string &use);

} // namespace dff
