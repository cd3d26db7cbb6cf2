/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sure_ratio.h"

#include <cmath>
#include <numeric>

namespace {

constexpr size_t least_count = 12;
constexpr double least_significance = 4; /* standard errors */

double mean(const std::vector<double> &values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/* Of the mean of `changes`, if they are `ratio` of the ways and what is left is chance. */
double standard_error(const std::vector<double> &changes, const std::vector<double> &ways, double ratio)
{
    double squares = 0;
    for (size_t k = 0; k < changes.size(); k++) {
        const double chance = changes[k] - ratio * ways[k];
        squares += chance * chance;
    }
    const auto count = static_cast<double>(changes.size());
    return std::sqrt(squares / (count - 1) / count);
}

} // namespace

std::optional<double> sure_ratio(const std::vector<double> &changes, const std::vector<double> &ways)
{
    if (changes.size() < least_count)
        return std::nullopt;
    const double change = mean(changes);
    const double ratio = change / mean(ways);
    if (!(std::abs(change) > least_significance * standard_error(changes, ways, ratio)))
        return std::nullopt;
    return ratio;
}
