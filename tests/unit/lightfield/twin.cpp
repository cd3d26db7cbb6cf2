/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "twin.h"

#include "engine/light_field_layers.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace dff {

namespace {

/* The rounded mean of the picture over a pixel of layers of this size. */
glm::dvec3 mean_over(const std::vector<glm::dvec3> &color, glm::ivec2 picture, glm::ivec2 size,
                     glm::ivec2 pixel)
{
    const glm::dvec2 scale = glm::dvec2(picture) / glm::dvec2(size);
    const glm::dvec2 begin = glm::dvec2(pixel) * scale, end = begin + scale;
    const auto covered = [](double from, double to, int i) {
        return std::min(to, i + 1.0) - std::max(from, i + 0.0);
    };
    glm::dvec3 sum(0.0);
    for (int y = static_cast<int>(begin.y); y < std::min<double>(end.y, picture.y); y++)
        for (int x = static_cast<int>(begin.x); x < std::min<double>(end.x, picture.x); x++)
            sum += covered(begin.x, end.x, x) * covered(begin.y, end.y, y) *
                   color[static_cast<size_t>(y * picture.x + x)];
    return glm::round(sum / (scale.x * scale.y));
}

} // namespace

TwinLayers::TwinLayers(const LightFieldGeometry &geometry, PictureSize picture,
                       const std::vector<glm::dvec3> &color, const std::vector<float> &positions)
    : size_(geometry.layers), lowest_(geometry.lowest), range_(geometry.range),
      step_(LightFieldLayers::edge_step * geometry.range),
      reach_(static_cast<int>(std::ceil(geometry.reach * geometry.range)) + 1)
{
    const glm::ivec2 whole(picture.width, picture.height);
    for (int y = 0; y < size_.y; y++)
        for (int x = 0; x < size_.x; x++) {
            const glm::ivec2 middle = glm::min(
                glm::ivec2((glm::dvec2(x, y) + 0.5) * glm::dvec2(whole) / glm::dvec2(size_)), whole - 1);
            color_.push_back(mean_over(color, whole, size_, {x, y}));
            height_.push_back(lowest_ +
                              range_ * (1.0 - positions[static_cast<size_t>(middle.y * whole.x + middle.x)]));
        }
    for (int y = 0; y < size_.y; y++)
        fill_unknown(y);
    hidden_color_ = color_;
    hidden_height_ = height_;
    for (int y = 0; y < size_.y; y++)
        hide(y);
}

void TwinLayers::fill_unknown(int y)
{
    const auto known_from = [&](int x, int direction) {
        while (x >= 0 && x < size_.x && std::isnan(height(x, y)))
            x += direction;
        return x >= 0 && x < size_.x ? height(x, y) : std::numeric_limits<double>::infinity();
    };
    std::vector<double> filled;
    for (int x = 0; x < size_.x; x++) {
        const double lower = std::min(known_from(x, -1), known_from(x, 1));
        filled.push_back(std::isinf(lower) ? 0.0 : std::isnan(height(x, y)) ? lower : height(x, y));
    }
    for (int x = 0; x < size_.x; x++)
        height(x, y) = filled[static_cast<size_t>(x)];
}

/* Walks away from the row's end to `x` and returns the ground that hides it at the end. */
int TwinLayers::ground(int x, int y, int direction) const
{
    int ground = -1;
    for (int i = direction > 0 ? 1 : size_.x - 2; direction > 0 ? i <= x : i >= x; i += direction) {
        if (height(i, y) - height(i - direction, y) > step_)
            ground = i - direction;
        if (ground >= 0 && (height(i, y) - height(ground, y) <= step_ || std::abs(i - ground) > reach_))
            ground = -1;
    }
    return ground;
}

glm::dvec3 TwinLayers::beyond(int x, int y, int ground) const
{
    const int mirrored = 2 * ground - x + (x > ground ? 1 : -1);
    const bool inside = mirrored >= 0 && mirrored < size_.x;
    const int i = inside && std::abs(height(mirrored, y) - height(ground, y)) <= step_ ? mirrored : ground;
    return color_[static_cast<size_t>(y * size_.x + i)];
}

void TwinLayers::hide(int y)
{
    for (int x = 0; x < size_.x; x++) {
        const int left = ground(x, y, 1), right = ground(x, y, -1);
        double share = left >= 0 ? 1.0 : 0.0;
        if (left >= 0 && right >= 0) {
            const double difference = height(left, y) - height(right, y);
            share = std::abs(difference) > step_ ? (difference < 0.0 ? 1.0 : 0.0)
                                                 : static_cast<double>(right - x) / (right - left);
        }
        if (left < 0 && right < 0)
            continue;
        const auto i = static_cast<size_t>(y * size_.x + x);
        hidden_color_[i] = glm::dvec3(0.0);
        hidden_height_[i] = 0.0;
        if (share > 0.0) {
            hidden_color_[i] += share * beyond(x, y, left);
            hidden_height_[i] += share * height(left, y);
        }
        if (share < 1.0) {
            hidden_color_[i] += (1.0 - share) * beyond(x, y, right);
            hidden_height_[i] += (1.0 - share) * height(right, y);
        }
        hidden_color_[i] = glm::round(hidden_color_[i]);
    }
}

glm::dvec3 TwinLayers::sample(const std::vector<glm::dvec3> &picture, glm::dvec2 point) const
{
    const glm::dvec2 p = glm::clamp(point, glm::dvec2(0.0), glm::dvec2(size_ - 1));
    const glm::ivec2 a(p), b = glm::min(a + 1, size_ - 1);
    const glm::dvec2 t = p - glm::dvec2(a);
    const auto at = [&](int x, int y) { return picture[static_cast<size_t>(y * size_.x + x)]; };
    return glm::mix(glm::mix(at(a.x, a.y), at(b.x, a.y), t.x), glm::mix(at(a.x, b.y), at(b.x, b.y), t.x),
                    t.y);
}

glm::dvec3 TwinLayers::trace(glm::dvec2 origin, glm::dvec2 slope, bool fill) const
{
    const int axis = std::abs(slope.x) >= std::abs(slope.y) ? 0 : 1;
    const double lean = slope[axis];
    if (std::abs(lean) * range_ < 1e-3)
        return sample(color_, origin + slope * lowest_);

    const double entry = origin[axis] + lean * (lowest_ + range_), exit = origin[axis] + lean * lowest_;
    const int direction = lean > 0.0 ? -1 : 1;
    const int first = static_cast<int>(direction < 0 ? std::ceil(entry) : std::floor(entry));
    const int last = static_cast<int>(direction < 0 ? std::floor(exit) - 1 : std::ceil(exit) + 1);
    double before = 0.0, q_before = 0.0;
    bool behind = false;
    for (int i = first; i != last + direction; i += direction) {
        const double q = (i - origin[axis]) / lean;
        const glm::dvec2 place = origin + slope * q;
        const glm::ivec2 p = glm::clamp(glm::ivec2(glm::round(place)), glm::ivec2(0), size_ - 1);
        const double here = height(p.x, p.y);
        const double hidden = hidden_height_[static_cast<size_t>(p.y * size_.x + p.x)];
        behind = q <= here &&
                 (behind || (i != first && here - before > step_ && (here - q) * std::abs(lean) > 1e-3));
        if (behind && (q <= hidden || i == last))
            return fill ? sample(hidden_color_, origin + slope * hidden) : glm::dvec3(0.0);
        if (!behind && q <= here) {
            const double share = i == first ? 1.0 : (q_before - before) / ((q_before - before) + (here - q));
            return sample(color_, origin + slope * glm::mix(i == first ? q : q_before, q, share));
        }
        before = here;
        q_before = q;
    }
    return sample(color_, origin + slope * lowest_);
}

} // namespace dff
