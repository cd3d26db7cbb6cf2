/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gpio_line_name.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace dff {

std::optional<GpioPlace> gpio_place(const std::string &name)
{
    const auto colon = name.rfind(':');
    if (colon == std::string::npos) {
        return std::nullopt;
    }
    const std::string offset = name.substr(colon + 1);
    const bool number =
        !offset.empty() && offset.size() < 6 &&
        std::all_of(offset.begin(), offset.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!number) {
        throw LineError("the GPIO line \"" + name + "\" has no number after its colon, as gpiochip0:5 has");
    }
    return GpioPlace{name.substr(0, colon), static_cast<unsigned>(std::stoul(offset))};
}

std::string system_reason()
{
    return std::generic_category().message(errno);
}

LineError no_gpio_line(const std::string &name)
{
    return LineError("no GPIO line is called \"" + name +
                     "\", or its chip cannot be opened. gpioinfo lists those there are; "
                     "gpiochip0:5 is the sixth line of the first chip");
}

LineError cannot_open_gpio_line(const std::string &name)
{
    return LineError(
        "cannot open the GPIO line \"" + name + "\": " + system_reason() +
        ". gpioinfo lists those there are; this user must be allowed to read and write the chip");
}

LineError gpio_line_refused(const std::string &name, const std::string &use)
{
    const bool busy = errno == EBUSY;
    return LineError("cannot take the GPIO line \"" + name + "\" as " + use + ": " + system_reason() +
                     (busy ? ". Somebody else has it; gpioinfo tells who" : ""));
}

} // namespace dff
