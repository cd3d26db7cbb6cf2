/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gpio_lines.h"

#include <algorithm>
#include <cerrno>
#include <gpiod.h>
#include <poll.h>
#include <system_error>

namespace dff {

namespace {

constexpr const char *consumer = "gst-plugins-dff";

std::string reason()
{
    return std::generic_category().message(errno);
}

struct CloseChip {
    void operator()(gpiod_line *line) const { gpiod_line_close_chip(line); }
};

/* A line with the chip that it alone holds open; letting it go releases both. */
using Line = std::unique_ptr<gpiod_line, CloseChip>;

Line find(const std::string &name)
{
    const auto colon = name.rfind(':');
    if (colon == std::string::npos) {
        Line line(gpiod_line_find(name.c_str()));
        if (!line) {
            throw LineError("no GPIO line is called \"" + name +
                            "\", or its chip cannot be opened. gpioinfo lists those there are; "
                            "gpiochip0:5 is the sixth line of the first chip");
        }
        return line;
    }
    const std::string offset = name.substr(colon + 1);
    const bool number =
        !offset.empty() && offset.size() < 6 &&
        std::all_of(offset.begin(), offset.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!number) {
        throw LineError("the GPIO line \"" + name + "\" has no number after its colon, as gpiochip0:5 has");
    }
    Line line(gpiod_line_get(name.substr(0, colon).c_str(), static_cast<unsigned>(std::stoul(offset))));
    if (!line) {
        throw LineError(
            "cannot open the GPIO line \"" + name + "\": " + reason() +
            ". gpioinfo lists those there are; this user must be allowed to read and write the chip");
    }
    return line;
}

LineError refused(const std::string &name, const std::string &use)
{
    const bool busy = errno == EBUSY;
    return LineError("cannot take the GPIO line \"" + name + "\" as " + use + ": " + reason() +
                     (busy ? ". Somebody else has it; gpioinfo tells who" : ""));
}

class GpiodOutputLine : public OutputLine {
public:
    explicit GpiodOutputLine(const std::string &name) : name_(name), line_(find(name))
    {
        if (gpiod_line_request_output(line_.get(), consumer, 0) < 0) {
            throw refused(name, "an output");
        }
    }

    ~GpiodOutputLine() override { gpiod_line_set_value(line_.get(), 0); }

    void set(bool high) override
    {
        if (gpiod_line_set_value(line_.get(), high ? 1 : 0) < 0) {
            throw LineError("cannot set the GPIO line \"" + name_ + "\": " + reason());
        }
    }

private:
    std::string name_;
    Line line_;
};

class GpiodEdgeLine : public EdgeLine {
public:
    explicit GpiodEdgeLine(const std::string &name) : name_(name), line_(find(name))
    {
        if (gpiod_line_request_rising_edge_events_flags(line_.get(), consumer,
                                                        GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) < 0) {
            throw refused(name, "an input with edges");
        }
    }

    int descriptor() const override { return gpiod_line_event_get_fd(line_.get()); }

    std::optional<LineEdge> read() override
    {
        pollfd events{descriptor(), POLLIN, 0};
        if (poll(&events, 1, 0) <= 0) {
            return std::nullopt;
        }
        if (events.revents & (POLLERR | POLLHUP | POLLNVAL)) {
            throw LineError("cannot wait for edges of the GPIO line \"" + name_ + "\": its chip has gone");
        }
        gpiod_line_event event{};
        if (gpiod_line_event_read(line_.get(), &event) < 0) {
            throw LineError("cannot read edges of the GPIO line \"" + name_ + "\": " + reason());
        }
        return LineEdge{static_cast<std::uint64_t>(event.ts.tv_sec) * 1'000'000'000U +
                        static_cast<std::uint64_t>(event.ts.tv_nsec)};
    }

private:
    std::string name_;
    Line line_;
};

} // namespace

std::unique_ptr<OutputLine> open_gpio_output_line(const std::string &name)
{
    return std::make_unique<GpiodOutputLine>(name);
}

std::unique_ptr<EdgeLine> open_gpio_edge_line(const std::string &name)
{
    return std::make_unique<GpiodEdgeLine>(name);
}

} // namespace dff
