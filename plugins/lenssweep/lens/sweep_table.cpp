/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_table.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace dff {

namespace {

using std::chrono::microseconds;
using sweep_registers::Word;

constexpr std::size_t fewest_planes = 2;
constexpr std::size_t most_planes = 64;

void require(bool good, const std::string &rule)
{
    if (!good) {
        throw std::invalid_argument("sweep table: " + rule);
    }
}

std::string text(microseconds time)
{
    return std::to_string(time.count()) + " us";
}

void require_range(const char *name, microseconds time, microseconds lowest, microseconds highest)
{
    require(time >= lowest && time <= highest,
            std::string(name) + " is " + text(time) + ", not " + text(lowest) + " to " + text(highest));
}

std::uint16_t word(microseconds time)
{
    return static_cast<std::uint16_t>(time.count());
}

} // namespace

void check(const SweepTable &table, const LensTiming &timing)
{
    const microseconds longest{std::numeric_limits<std::uint16_t>::max()};
    const microseconds longest_opto{std::numeric_limits<std::uint8_t>::max()};
    const microseconds zero{0};

    require(table.planes.size() >= fewest_planes && table.planes.size() <= most_planes,
            std::to_string(table.planes.size()) + " planes, not 2 to 64");
    require_range("period", table.period, zero, longest);
    require_range("exposure", table.exposure, timing.stage, longest);
    require_range("flyback", table.flyback, zero, longest);
    require_range("trigger width", table.trigger_width, microseconds{1}, table.exposure);
    require_range("opto-isolator on", table.opto_on, zero, longest_opto);
    require_range("opto-isolator off", table.opto_off, zero, longest_opto);

    const auto lead = table.trigger_active_low ? table.opto_off : table.opto_on;
    const auto trail = table.trigger_active_low ? table.opto_on : table.opto_off;
    require(table.trigger_width + lead > trail,
            "the trigger width of " + text(table.trigger_width) + " is lost in the opto-isolator");

    const auto gap = table.period - table.exposure;
    for (std::size_t index = 0; index < table.planes.size(); ++index) {
        const PlaneStep &plane = table.planes[index];
        const std::string name = "plane " + std::to_string(index);
        require_range((name + " delay").c_str(), plane.delay, zero, longest);
        require_range((name + " settle").c_str(), plane.settle, zero, longest);
        const auto needed = timing.gap + plane.delay + std::max(plane.settle, lead);
        require(needed <= gap, name + " needs " + text(needed) +
                                   " between two exposures, and period - exposure is " + text(gap));
        table.driver->code(plane.overdrive);
        table.driver->code(plane.hold);
    }
}

std::vector<RegisterWrite> register_writes(const SweepTable &table)
{
    const auto shape =
        static_cast<std::uint16_t>(sweep_registers::shape_triangle.place(table.triangle) |
                                   sweep_registers::shape_trigger_active_low.place(table.trigger_active_low));
    const auto &driver = *table.driver;
    /* In the order of the words, so that one block carries them */
    std::vector<RegisterWrite> writes{
        {Word::planes,
         {static_cast<std::uint16_t>(table.planes.size()), shape, word(table.period), word(table.exposure),
          word(table.flyback), word(table.trigger_width), word(table.opto_on), word(table.opto_off)}}};
    writes.front().values.insert(writes.front().values.end(), driver.words.begin(), driver.words.end());
    for (std::size_t index = 0; index < table.planes.size(); ++index) {
        const PlaneStep &plane = table.planes[index];
        writes.push_back({Word::plane_select,
                          {static_cast<std::uint16_t>(index), driver.table_code(plane.overdrive),
                           word(plane.delay), driver.table_code(plane.hold), word(plane.settle)}});
    }
    return writes;
}

} // namespace dff
