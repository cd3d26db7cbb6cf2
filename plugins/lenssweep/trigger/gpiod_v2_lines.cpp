/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gpio_line_name.h"
#include "gpio_lines.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <gpiod.h>
#include <poll.h>
#include <vector>

namespace dff {

namespace {

template <auto free> struct Free {
    void operator()(auto *object) const { free(object); }
};

using Chip = std::unique_ptr<gpiod_chip, Free<gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Free<gpiod_chip_info_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, Free<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, Free<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Free<gpiod_request_config_free>>;
using Request = std::unique_ptr<gpiod_line_request, Free<gpiod_line_request_release>>;
using EdgeBuffer = std::unique_ptr<gpiod_edge_event_buffer, Free<gpiod_edge_event_buffer_free>>;

/* What libgpiod makes is there, or memory has run out. */
template <typename T> T made(T object)
{
    if (!object) {
        throw std::bad_alloc();
    }
    return object;
}

/* The chips there are, in the order of their names. */
std::vector<std::string> chip_paths()
{
    std::vector<std::string> paths;
    std::error_code error;
    for (const auto &entry : std::filesystem::directory_iterator("/dev", error)) {
        if (entry.path().filename().string().starts_with("gpiochip")) {
            paths.push_back(entry.path());
        }
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

/* By its path, its name, its number or its label. */
Chip open_chip(const std::string &chip)
{
    for (const std::string &path : {chip, "/dev/" + chip, "/dev/gpiochip" + chip}) {
        if (path.starts_with("/") && gpiod_is_gpiochip_device(path.c_str())) {
            return Chip(gpiod_chip_open(path.c_str()));
        }
    }
    for (const std::string &path : chip_paths()) {
        Chip open(gpiod_chip_open(path.c_str()));
        const ChipInfo info(open ? gpiod_chip_get_info(open.get()) : nullptr);
        if (info && chip == gpiod_chip_info_get_label(info.get())) {
            return open;
        }
    }
    errno = ENOENT;
    return nullptr;
}

struct Line {
    Chip chip;
    unsigned offset;
};

Line find(const std::string &name)
{
    if (const std::optional<GpioPlace> place = gpio_place(name)) {
        Line line{open_chip(place->chip), place->offset};
        if (!line.chip) {
            throw cannot_open_gpio_line(name);
        }
        return line;
    }
    for (const std::string &path : chip_paths()) {
        Chip chip(gpiod_chip_open(path.c_str()));
        const int offset = chip ? gpiod_chip_get_line_offset_from_name(chip.get(), name.c_str()) : -1;
        if (offset >= 0) {
            return {std::move(chip), static_cast<unsigned>(offset)};
        }
    }
    throw no_gpio_line(name);
}

/* The line is ours as long as the request lives; the chip may be closed before. */
Request request(const Line &line, gpiod_line_settings *settings)
{
    const LineConfig lines(made(gpiod_line_config_new()));
    const RequestConfig config(made(gpiod_request_config_new()));
    gpiod_request_config_set_consumer(config.get(), gpio_consumer);
    if (gpiod_line_config_add_line_settings(lines.get(), &line.offset, 1, settings) < 0) {
        return nullptr;
    }
    return Request(gpiod_chip_request_lines(line.chip.get(), config.get(), lines.get()));
}

Request request_output(const std::string &name)
{
    const Settings settings(made(gpiod_line_settings_new()));
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
    Request line = request(find(name), settings.get());
    if (!line) {
        throw gpio_line_refused(name, "an output");
    }
    return line;
}

Request request_edges(const std::string &name)
{
    const Settings settings(made(gpiod_line_settings_new()));
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_RISING);
    gpiod_line_settings_set_bias(settings.get(), GPIOD_LINE_BIAS_PULL_DOWN);
    gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
    Request line = request(find(name), settings.get());
    if (!line) {
        throw gpio_line_refused(name, "an input with edges");
    }
    return line;
}

unsigned offset_of(const Request &line)
{
    unsigned offset = 0;
    gpiod_line_request_get_requested_offsets(line.get(), &offset, 1);
    return offset;
}

class GpiodOutputLine : public OutputLine {
public:
    explicit GpiodOutputLine(const std::string &name)
        : name_(name), line_(request_output(name)), offset_(offset_of(line_))
    {
    }

    ~GpiodOutputLine() override
    {
        gpiod_line_request_set_value(line_.get(), offset_, GPIOD_LINE_VALUE_INACTIVE);
    }

    void set(bool high) override
    {
        const gpiod_line_value value = high ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
        if (gpiod_line_request_set_value(line_.get(), offset_, value) < 0) {
            throw LineError("cannot set the GPIO line \"" + name_ + "\": " + system_reason());
        }
    }

private:
    std::string name_;
    Request line_;
    unsigned offset_;
};

class GpiodEdgeLine : public EdgeLine {
public:
    explicit GpiodEdgeLine(const std::string &name)
        : name_(name), line_(request_edges(name)), events_(made(gpiod_edge_event_buffer_new(1)))
    {
    }

    int descriptor() const override { return gpiod_line_request_get_fd(line_.get()); }

    std::optional<LineEdge> read() override
    {
        pollfd events{descriptor(), POLLIN, 0};
        if (poll(&events, 1, 0) <= 0) {
            return std::nullopt;
        }
        if (events.revents & (POLLERR | POLLHUP | POLLNVAL)) {
            throw LineError("cannot wait for edges of the GPIO line \"" + name_ + "\": its chip has gone");
        }
        if (gpiod_line_request_read_edge_events(line_.get(), events_.get(), 1) < 1) {
            throw LineError("cannot read edges of the GPIO line \"" + name_ + "\": " + system_reason());
        }
        return LineEdge{
            gpiod_edge_event_get_timestamp_ns(gpiod_edge_event_buffer_get_event(events_.get(), 0))};
    }

private:
    std::string name_;
    Request line_;
    EdgeBuffer events_;
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
