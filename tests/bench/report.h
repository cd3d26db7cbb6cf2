/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "row.h"

#include <cstdint>
#include <fstream>
#include <span>
#include <sstream>

namespace dff::bench {

struct Case {
    uint32_t width, height, planes;
    bool with_others; /* the ways that are not ours too */
};

/* What was timed, as Markdown for readers and as JSON for plot.py. */
class Report {
public:
    Report(const char *markdown, const char *json) : markdown_(markdown), json_(json) { json_ << "[\n"; }
    ~Report();
    Report(const Report &) = delete;
    Report &operator=(const Report &) = delete;

    /* The first row is the copy. */
    void add(const Case &c, std::span<const Row> rows, double memory_mib);

private:
    void add_linearity(const Case &c, std::span<const Row> rows);
    void compare(std::span<const Row> rows);
    void add_json(const Case &c, const Row &row, double copy, double memory_mib);

    std::ofstream markdown_, json_;
    std::ostringstream linearity_;
    bool first_ = true;
};

} // namespace dff::bench
