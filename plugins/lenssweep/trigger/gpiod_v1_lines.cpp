/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gpio_line_name.h"
#include "gpio_lines.h"

#include <gpiod.h>
#include <poll.h>

namespace dff {

namespace {

struct CloseChip {
    void operator()(gpiod_line *line) const { gpiod_line_close_chip(line); }
};

/* A line with the chip that it alone holds open; letting it go releases both. */
using Line = std::unique_ptr<gpiod_line, CloseChip>;

Line find(const std::string &name)
{
    const std::optional<GpioPlace> place = gpio_place(name);
    if (!place) {
        Line line(gpiod_line_find(name.c_str()));
        if (!line) {
            throw no_gpio_line(name);
        }
        return line;
    }
    Line line(gpiod_line_get(place->chip.c_str(), place->offset));
    if (!line) {
        throw cannot_open_gpio_line(name);
    }
    return line;
}

class GpiodOutputLine : public OutputLine {
public:
    explicit GpiodOutputLine(const std::string &name) : name_(name), line_(find(name))
    {
        if (gpiod_line_request_output(line_.get(), gpio_consumer, 0) < 0) {
            throw gpio_line_refused(name, "an output");
        }
    }

    ~GpiodOutputLine() override { gpiod_line_set_value(line_.get(), 0); }

    void set(bool high) override
    {
        if (gpiod_line_set_value(line_.get(), high ? 1 : 0) < 0) {
            throw LineError("cannot set the GPIO line \"" + name_ + "\": " + system_reason());
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
        if (gpiod_line_request_rising_edge_events_flags(line_.get(), gpio_consumer,
                                                        GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) < 0) {
            throw gpio_line_refused(name, "an input with edges");
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
            throw LineError("cannot read edges of the GPIO line \"" + name_ + "\": " + system_reason());
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
