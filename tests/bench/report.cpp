/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "report.h"

#include <cmath>

namespace dff::bench {

namespace {

double rounded(double value)
{
    return std::round(value * 100.0) / 100.0;
}

} // namespace

Report::~Report()
{
    json_ << "\n]\n";
    markdown_
        << "\n## Linearity\n\nMilliseconds a million pixels and plane, wall (processor); flat is linear.\n\n"
        << "| | N | method=paper | and AIF | method=volume | and AIF |\n|---|---|---|---|---|---|\n"
        << linearity_.str();
}

void Report::add(const Case &c, std::span<const Row> rows, double memory_mib)
{
    const double copy = median(rows.front().wall);
    markdown_ << "\n## " << c.width << "x" << c.height << ", N=" << c.planes << "\n\n"
              << "Peak memory of the process: " << static_cast<int>(memory_mib) << " MiB.\n\n"
              << "| | ms | of a copy | stacks/s | processor ms |\n|---|---|---|---|---|\n";
    for (const Row &row : rows) {
        const double wall = median(row.wall);
        markdown_ << "| " << row.name << " | " << rounded(wall) << " | " << rounded(wall / copy) << " | "
                  << rounded(1e3 / wall) << " | " << rounded(median(row.processor)) << " |\n";
        for (const auto &[stage, times] : row.stages)
            markdown_ << "| &nbsp;&nbsp;" << stage << " | " << rounded(median(times)) << " | "
                      << rounded(median(times) / copy) << " | | |\n";
        add_json(c, row, copy, memory_mib);
    }
    add_linearity(c, rows);
    if (c.with_others)
        compare(rows);
    markdown_.flush();
}

void Report::add_linearity(const Case &c, std::span<const Row> rows)
{
    const double megapixel_planes = 1e-6 * c.width * c.height * c.planes;
    linearity_ << "| " << c.width << "x" << c.height << " | " << c.planes << " |";
    for (const Row &row : rows)
        if (row.kind == Row::Kind::Ours)
            linearity_ << " " << rounded(median(row.wall) / megapixel_planes) << " ("
                       << rounded(median(row.processor) / megapixel_planes) << ") |";
    linearity_ << "\n";
}

void Report::compare(std::span<const Row> rows)
{
    markdown_ << "\nHow many times as fast as others' ways, which are parts of the whole alone; by wall time "
                 "(by processor time):\n\n| |";
    std::string line = "\n|---|";
    for (const Row &ours : rows)
        if (ours.kind == Row::Kind::Ours) {
            markdown_ << " " << ours.name << " |";
            line += "---|";
        }
    markdown_ << line << "\n";
    for (const Row &others : rows) {
        if (others.kind != Row::Kind::Others)
            continue;
        markdown_ << "| " << others.name << " |";
        for (const Row &ours : rows)
            if (ours.kind == Row::Kind::Ours)
                markdown_ << " " << rounded(median(others.wall) / median(ours.wall)) << " ("
                          << rounded(median(others.processor) / median(ours.processor)) << ") |";
        markdown_ << "\n";
    }
}

void Report::add_json(const Case &c, const Row &row, double copy, double memory_mib)
{
    json_ << (first_ ? "" : ",\n") << R"({"width": )" << c.width << R"(, "height": )" << c.height
          << R"(, "planes": )" << c.planes << R"(, "name": ")" << row.name << R"(", "ms": )"
          << median(row.wall) << R"(, "of_copy": )" << median(row.wall) / copy << R"(, "cpu_ms": )"
          << median(row.processor) << R"(, "peak_mib": )" << memory_mib << R"(, "stages": {)";
    for (size_t i = 0; i < row.stages.size(); i++)
        json_ << (i ? ", " : "") << '"' << row.stages[i].first << "\": " << median(row.stages[i].second);
    json_ << "}}";
    first_ = false;
}

} // namespace dff::bench
