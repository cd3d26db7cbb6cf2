/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lens_points.h"

#include "lens_profile_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace dff {

namespace {

double number_of(const std::string &text, const std::string &whole)
{
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
        throw std::invalid_argument("--points \"" + whole +
                                    "\" are none: give POSITION=METRES,POSITION=METRES, as 120=2.0,310=0.5");
    return number;
}

LensPoint point_of(const std::string &text, const std::string &whole)
{
    const std::size_t sign = text.find('=');
    const LensPoint point{number_of(text.substr(0, sign), whole),
                          number_of(sign == std::string::npos ? "" : text.substr(sign + 1), whole)};
    constexpr double most_position = 1e9; /* that a lens profile may have */
    if (std::abs(point.position) > most_position)
        throw std::invalid_argument("A position of --points must be within -1e9 and 1e9");
    if (!(point.metres >= 0.001))
        throw std::invalid_argument("A distance of --points must be a millimetre or more, in metres");
    return point;
}

} // namespace

LensPoints LensPoints::parse(const std::string &text)
{
    LensPoints result;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');)
        result.points_.push_back(point_of(part, text));
    auto &points = result.points_;
    std::sort(points.begin(), points.end(), [](const auto &a, const auto &b) { return a.metres > b.metres; });
    const auto same = std::adjacent_find(points.begin(), points.end(),
                                         [](const auto &a, const auto &b) { return a.metres == b.metres; });
    if (points.size() < 2 || same != points.end())
        throw std::invalid_argument("--points needs two distances or more, each once");
    std::vector<double> positions;
    for (const LensPoint &point : points)
        positions.push_back(point.position);
    const bool rises =
        std::adjacent_find(positions.begin(), positions.end(), std::greater_equal<>()) == positions.end();
    const bool falls =
        std::adjacent_find(positions.begin(), positions.end(), std::less_equal<>()) == positions.end();
    if (!rises && !falls)
        throw std::invalid_argument(
            "Positions of --points must only rise, or only fall, as the distance grows: look "
            "which of them was measured wrongly");
    return result;
}

std::optional<double> LensPoints::largest_miss() const
{
    if (points_.size() < 3)
        return std::nullopt;
    double largest = 0.0;
    for (std::size_t k = 1; k + 1 < points_.size(); k++) {
        const LensPoint &before = points_[k - 1], &behind = points_[k + 1];
        const double share = (points_[k].position - before.position) / (behind.position - before.position);
        const double line = std::lerp(before.vergence(), behind.vergence(), share);
        largest = std::max(largest, std::abs(line - points_[k].vergence()));
    }
    return largest;
}

std::string LensPoints::worth() const
{
    std::ostringstream text;
    text << std::fixed << std::setprecision(3);
    const auto miss = largest_miss();
    if (!miss)
        return "Two points say nothing of their error: measure a third between them.";
    text << "Straight lines between points miss what lies between by up to " << *miss << " dioptres:";
    for (const LensPoint &point : {points_.front(), points_.back()})
        text << ' ' << std::setprecision(0) << 1e3 * *miss * point.metres * point.metres << " mm at "
             << std::setprecision(2) << point.metres << " m,";
    std::string line = text.str();
    line.back() = '.';
    return line + " With a point more in each gap it is about a quarter.";
}

void LensPoints::write(const std::string &path, const std::string &lens) const
{
    std::vector<double> vergences, positions;
    for (const LensPoint &point : points_) {
        vergences.push_back(point.vergence());
        positions.push_back(point.position);
    }
    write_focus_points(path, lens, std::move(vergences), std::move(positions));
}

} // namespace dff
