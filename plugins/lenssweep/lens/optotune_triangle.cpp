/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optotune_triangle.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

constexpr double unevenness = 0.1; /* of a step: planes may lie so far from where the triangle passes */

FocusPoints in_milliamperes(const std::optional<FocusPoints> &points)
{
    if (!points || points->unit() != "mA")
        throw std::invalid_argument(
            "the triangle of an Optotune Lens Driver goes between two currents: lens-profile must give the "
            "lens's currents, with unit \"mA\". mode=step moves it by focal power");
    return *points;
}

/* mA from a plane to the next. */
double step_of(const std::vector<double> &currents)
{
    const double step = (currents.back() - currents.front()) / static_cast<double>(currents.size() - 1);
    for (std::size_t plane = 0; plane < currents.size(); ++plane) {
        const double even = currents.front() + step * static_cast<double>(plane);
        if (std::abs(currents[plane] - even) > unevenness * std::abs(step))
            throw std::invalid_argument("the driver's triangle is even in its current, and these planes are "
                                        "not, by the lens profile: "
                                        "use mode=step, or planes between two of its points");
    }
    if (step >= 0)
        throw std::invalid_argument(
            "the driver gives its edge at the greatest current, which must be that of "
            "the nearest plane: see the positions of the lens profile");
    return step;
}

} // namespace

OptotuneTriangle::OptotuneTriangle(const std::string &device, const std::optional<FocusPoints> &points)
    : points_(in_milliamperes(points)), driver_(device)
{
}

OptotuneTriangle::~OptotuneTriangle()
{
    try {
        stop();
    } catch (const LensError &) {
        /* Nothing more can be done: the driver is unplugged, or does not hear. */
    }
}

void OptotuneTriangle::prepare(const LensSweep &sweep)
{
    if (sweep.period.count() <= 0)
        throw std::invalid_argument("the frame rate is not known: put a capsfilter with it before");
    std::vector<double> currents;
    for (unsigned plane = 0; plane < sweep.plan.planes(); ++plane)
        currents.push_back(points_.position(sweep.plan.power(plane)));
    const double step = step_of(currents);
    const double upper = currents.front() - step / 2;
    const double lower = currents.back() + step / 2;
    const double greatest = driver_.greatest_current();
    if (upper > greatest || lower < -greatest) {
        std::ostringstream text;
        text << "the Optotune lens driver reaches " << -greatest << " to " << greatest
             << " mA, and its triangle, which turns half a plane beyond near and far, would go from " << lower
             << " to " << upper << ": set near and far";
        throw std::invalid_argument(text.str());
    }
    const double hertz = 1e6 / static_cast<double>(sweep.period.count()) / (2.0 * sweep.plan.planes());
    if (hertz < OptotuneDriver::triangle_hertz.least || hertz > OptotuneDriver::triangle_hertz.greatest) {
        std::ostringstream text;
        text << "the Optotune lens driver goes to and fro " << OptotuneDriver::triangle_hertz.least << " to "
             << OptotuneDriver::triangle_hertz.greatest
             << " times a second, and with these planes it would be " << hertz;
        throw std::invalid_argument(text.str());
    }
    currents_ = std::move(currents);
    upper_ = upper;
    lower_ = lower;
    hertz_ = hertz;
}

void OptotuneTriangle::start()
{
    driver_.start_triangle(lower_, upper_, hertz_);
}

void OptotuneTriangle::stop()
{
    driver_.rest();
}

int OptotuneTriangle::code(unsigned plane) const
{
    return driver_.current_code(currents_.at(plane));
}

void OptotuneTriangle::check()
{
    driver_.check_temperature();
}

} // namespace dff
