/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/focus_points.h"

#include "optics/settings_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

constexpr Range dioptres{-1000.0, 1000.0};
constexpr Range positions_range{-1e9, 1e9};
constexpr size_t most_points = 1000;

bool rises(const std::vector<double> &numbers)
{
    return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
}

bool falls(const std::vector<double> &numbers)
{
    return std::adjacent_find(numbers.begin(), numbers.end(), std::less_equal<>()) == numbers.end();
}

} // namespace

FocusPoints FocusPoints::load(const std::string &file)
try {
    const FileEntries entries("the lens profile", file);
    FocusPoints points;
    points.lens_ = entries.text("lens");
    points.unit_ = entries.has("unit") ? entries.text("unit") : "";
    points.vergences_ = entries.numbers("vergence", 2, most_points, dioptres);
    points.positions_ = entries.numbers("position", 2, most_points, positions_range);
    if (points.vergences_.size() != points.positions_.size())
        entries.fail("vergence and position differ in length");
    if (!rises(points.vergences_))
        entries.fail("vergence must be numbers, each greater than the one before");
    if (!rises(points.positions_) && !falls(points.positions_))
        entries.fail("position must be numbers that only rise, or only fall");
    return points;
} catch (const std::runtime_error &error) {
    throw std::invalid_argument(error.what()); /* as of other settings that cannot be used */
}

double FocusPoints::position(double vergence) const
{
    constexpr double rounding = 1e-9; /* dioptres */
    if (!(vergence >= farthest() - rounding && vergence <= nearest() + rounding)) {
        std::ostringstream text;
        text << "the points of the lens " << lens_ << " reach from " << farthest() << " to " << nearest()
             << " dioptres, not to " << vergence << ": measure more of them, or set near and far";
        throw std::invalid_argument(text.str());
    }
    const auto above = std::upper_bound(vergences_.begin() + 1, vergences_.end() - 1, vergence);
    const auto k = static_cast<size_t>(above - vergences_.begin()) - 1;
    const double part = (vergence - vergences_[k]) / (vergences_[k + 1] - vergences_[k]);
    return std::lerp(positions_[k], positions_[k + 1], std::clamp(part, 0.0, 1.0));
}

} // namespace dff
