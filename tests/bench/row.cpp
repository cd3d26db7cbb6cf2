/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "row.h"

#include <algorithm>
#include <chrono>
#include <sys/resource.h>

namespace dff::bench {

namespace {

double seconds_of(const timeval &time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double processor_ms()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * (seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime));
}

double wall_ms()
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

} // namespace

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

void Row::run()
{
    const double wall_start = wall_ms(), processor_start = processor_ms();
    const StageTimes *times = work();
    processor.push_back(processor_ms() - processor_start);
    wall.push_back(wall_ms() - wall_start);
    for (size_t i = 0; times && i < times->size(); i++) {
        if (stages.size() <= i)
            stages.emplace_back((*times)[i].first, std::vector<double>());
        stages[i].second.push_back((*times)[i].second);
    }
}

} // namespace dff::bench
