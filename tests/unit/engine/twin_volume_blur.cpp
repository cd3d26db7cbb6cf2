/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Twins of what follows the blur step. */
#include "twin_volume.h"

#include <algorithm>
#include <cmath>

namespace dff::twin {

namespace {

/* Ends repeated: -1 is 0. */
unsigned reflect(int i, unsigned n)
{
    const int size = static_cast<int>(n);
    i = i < 0 ? -1 - i : i < size ? i : 2 * size - 1 - i;
    return static_cast<unsigned>(std::clamp(i, 0, size - 1));
}

float at(const Volume &v, int x, int y, unsigned z = 0)
{
    return v.at(reflect(x, v.width), reflect(y, v.height), z);
}

template <typename Value> Volume make(unsigned width, unsigned height, unsigned planes, const Value &value)
{
    Volume result(width, height, planes);
    for (unsigned z = 0; z < planes; z++)
        for (unsigned y = 0; y < height; y++)
            for (unsigned x = 0; x < width; x++)
                result.at(x, y, z) = value(static_cast<int>(x), static_cast<int>(y), z);
    return result;
}

template <typename Value> Volume like(const Volume &v, const Value &value)
{
    return make(v.width, v.height, v.planes, value);
}

/* Mean over 3x3 with the weights side 1 - 2 side, side in both directions. */
Volume filter_3x3(const Volume &v, float side)
{
    return like(v, [&](int x, int y, unsigned z) {
        float sum = 0.0f;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                sum += (i ? side : 1.0f - 2.0f * side) * (j ? side : 1.0f - 2.0f * side) *
                       at(v, x + i, y + j, z);
        return sum;
    });
}

/* The greatest around: of a square and of a cross in turn, less `slope` each time. */
Volume spread(Volume v, int cells, float slope)
{
    for (int step = 0; step < cells; step++) {
        const Volume before = v;
        v = like(before, [&](int x, int y, unsigned z) {
            float greatest = at(before, x, y, z);
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++)
                    if (step % 2 == 0 || i == 0 || j == 0)
                        greatest = std::max(greatest, at(before, x + i, y + j, z) - (i || j ? slope : 0.0f));
            return greatest;
        });
    }
    return v;
}

float clip(float v)
{
    return std::clamp(v, 0.0f, 1.0f);
}

} // namespace

Volume mean_of_small(const Colours &small)
{
    return like(small[0], [&](int x, int y, unsigned z) {
        return (small[0].at(x, y, z) + small[1].at(x, y, z) + small[2].at(x, y, z)) / 3.0f;
    });
}

Volume focus_on_scale(const Volume &luma, float t)
{
    const Volume soft = filter_3x3(luma, t > 0.1f ? 0.32f * t * t : 0.0f);
    const Volume sml = like(soft, [&](int x, int y, unsigned z) {
        const float twice = 2.0f * soft.at(x, y, z);
        return std::abs(twice - at(soft, x - 1, y, z) - at(soft, x + 1, y, z)) +
               std::abs(twice - at(soft, x, y - 1, z) - at(soft, x, y + 1, z));
    });
    return filter_3x3(sml, 1.0f / 3.0f);
}

Volume least_over_planes(const Volume &focus)
{
    return make(focus.width, focus.height, 1, [&](int x, int y, unsigned) {
        float least = focus.at(x, y, 0);
        for (unsigned z = 1; z < focus.planes; z++)
            least = std::min(least, focus.at(x, y, z));
        return least;
    });
}

float quantile(std::vector<float> values, double share)
{
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<size_t>(place)];
}

float fall_beside_peaks(const Volume &focus)
{
    const float floor = quantile(least_over_planes(focus).values, 0.5);
    std::vector<std::pair<float, float>> peaks; /* how high, rho */
    for (unsigned y = 0; y < focus.height; y++)
        for (unsigned x = 0; x < focus.width; x++) {
            unsigned k = 0;
            for (unsigned z = 1; z < focus.planes; z++)
                if (focus.at(x, y, z) > focus.at(x, y, k))
                    k = z;
            const float peak = focus.at(x, y, k) - floor;
            if (k == 0 || k + 1 == focus.planes || peak <= 0.0f)
                continue;
            const float sides =
                std::max(focus.at(x, y, k - 1) - floor, 0.0f) + std::max(focus.at(x, y, k + 1) - floor, 0.0f);
            peaks.emplace_back(peak, sides / (2.0f * peak));
        }
    if (peaks.size() < 50)
        return 2.0f;
    std::sort(peaks.rbegin(), peaks.rend());
    std::vector<float> strongest;
    for (size_t i = 0; i < peaks.size() / 10 + 1; i++)
        strongest.push_back(peaks[i].second);
    return quantile(strongest, 0.5);
}

Volume without_leak(const Volume &focus, float middle, float blur_step, unsigned scale, float t)
{
    const Volume above =
        like(focus, [&](int x, int y, unsigned z) { return std::max(focus.at(x, y, z) - middle, 0.0f); });
    Volume leak(focus.width, focus.height, focus.planes);
    for (unsigned distance = 1; distance < focus.planes; distance++) {
        const float radius = static_cast<float>(distance) * blur_step / (2.0f * static_cast<float>(scale));
        const int reach = static_cast<int>(std::lround(radius + 1.0f));
        if (radius < 1.0f || reach > 24)
            continue;
        const float share = 0.9f * clip(blur_step - 2.0f) * (1.0f - 0.5f * t * t) * std::pow(radius, -0.4f);
        const Volume reached = spread(above, reach, 0.0f);
        leak = like(leak, [&](int x, int y, unsigned z) {
            float most = leak.at(x, y, z);
            if (z >= distance)
                most = std::max(most, share * reached.at(x, y, z - distance));
            if (z + distance < focus.planes)
                most = std::max(most, share * reached.at(x, y, z + distance));
            return most;
        });
    }
    return like(focus, [&](int x, int y, unsigned z) {
        return std::max(focus.at(x, y, z) - leak.at(x, y, z), 0.0f);
    });
}

std::vector<float> noise_curve(const Volume &focus, const Colours &small)
{
    std::array<std::vector<float>, 16> values;
    for (size_t i = 0; i < focus.values.size(); i++) {
        const float light = small[0].values[i] + small[1].values[i] + small[2].values[i];
        values[std::min(static_cast<size_t>(light / 768.0f * 16.0f), size_t{15})].push_back(32.0f *
                                                                                            focus.values[i]);
    }
    /* Normal equations of the parabola, by Gauss's elimination. */
    std::array<std::array<double, 4>, 3> rows{};
    float least = 1.0f, greatest = 0.0f;
    for (size_t bin = 0; bin < values.size(); bin++) {
        if (values[bin].size() < 50)
            continue;
        const double brightness = (static_cast<double>(bin) + 0.5) / 16.0;
        const double weight = std::sqrt(static_cast<double>(values[bin].size()));
        least = std::min(least, static_cast<float>(brightness));
        greatest = std::max(greatest, static_cast<float>(brightness));
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++)
                rows[i][j] += weight * std::pow(brightness, i + j);
            rows[i][3] += weight * std::pow(brightness, i) * quantile(values[bin], 0.1);
        }
    }
    const double little = 1e-3 * rows[0][0];
    rows[0][2] += little;
    rows[1][1] += little;
    rows[2][0] += little;
    rows[2][2] += little;
    for (int pivot = 0; pivot < 3; pivot++)
        for (int i = 0; i < 3; i++) {
            const double factor = rows[i][pivot] / rows[pivot][pivot];
            for (int j = 0; j < 4 && i != pivot; j++)
                rows[i][j] -= factor * rows[pivot][j];
        }
    std::vector<float> curve;
    for (int i = 0; i < 3; i++)
        curve.push_back(static_cast<float>(rows[i][3] / rows[i][i]));
    curve.push_back(least);
    curve.push_back(greatest);
    return curve;
}

std::vector<float> not_fallen_deep(std::vector<float> curve)
{
    if (curve[2] >= 0.0f)
        return curve;
    const float vertex = -curve[1] / (2.0f * curve[2]);
    const float most = std::max(curve[0] - curve[1] * curve[1] / (4.0f * curve[2]), 0.0f);
    curve[4] = std::max(std::min(curve[4], vertex + std::sqrt(most / (-4.0f * curve[2]))), curve[3]);
    return curve;
}

Volume even_noise(const Volume &focus, const Colours &small, const std::vector<float> &curve, float t)
{
    const auto noise_at = [&](int x, int y, unsigned z) {
        const float light = (small[0].at(x, y, z) + small[1].at(x, y, z) + small[2].at(x, y, z)) / 768.0f;
        const float i = std::clamp(light, curve[3], curve[4]);
        return (curve[0] + i * (curve[1] + i * curve[2])) / 32.0f; /* FOCUS_ONE */
    };
    return like(focus, [&](int x, int y, unsigned z) {
        float mean = 0.0f, limit = focus.at(x, y, 0);
        for (unsigned plane = 0; plane < focus.planes; plane++) {
            mean += noise_at(x, y, plane) / static_cast<float>(focus.planes);
            limit = std::min(limit, focus.at(x, y, plane));
        }
        limit *= 3.0f;
        const float excess = (3.0f - 1.8f * t) * (noise_at(x, y, z) - mean);
        return std::max(focus.at(x, y, z) - std::clamp(excess, -limit, limit), 0.0f);
    });
}

Volume doubt_nearer_side(const Volume &confidence, const Volume &u, const Volume &cost, float blur_step,
                         unsigned scale, float t)
{
    const auto planes = static_cast<int>(cost.planes);
    const float cells = blur_step / static_cast<float>(scale), slope = 1.25f * 2.0f / cells;
    const Volume near_by = spread(u, std::max(static_cast<int>(std::lround(cells)), 1), 0.0f);
    const Volume cone =
        spread(u, std::min(static_cast<int>(std::ceil(static_cast<float>(planes - 1) / slope)), 64), slope);
    return like(confidence, [&](int x, int y, unsigned) {
        const float own = u.at(x, y), far = std::max(near_by.at(x, y), cone.at(x, y));
        const float beyond = std::max(far - own - 0.5f, 0.0f);
        float rival = 9.0f;
        for (int z = 0; z < planes; z++)
            if (static_cast<float>(z) > own + 1.0f && static_cast<float>(z) < far + 1.0f)
                rival = std::min(rival, cost.at(x, y, z));
        const float gain = rival - cost.at(x, y, static_cast<unsigned>(std::lrint(own)));
        const float share = 8.0f * clip((0.5f + t) * (blur_step - 2.5f - 0.5f * t));
        return confidence.at(x, y) / (1.0f + share * clip(1.0f - gain / 0.7f) * beyond);
    });
}

Volume refine(const Volume &u, const Volume &focus, int apart, float t)
{
    const float floor = quantile(least_over_planes(focus).values, 0.1);
    const float factor = std::floor(static_cast<float>(u.width) / static_cast<float>(focus.width));
    const auto last = static_cast<int>(focus.planes) - 1;
    const Volume placed = like(u, [&](int x, int y, unsigned) {
        const float fx = (static_cast<float>(x) + 0.5f) / factor - 0.5f,
                    fy = (static_cast<float>(y) + 0.5f) / factor - 0.5f;
        const int left = static_cast<int>(std::floor(fx)), top = static_cast<int>(std::floor(fy));
        const float ax = fx - static_cast<float>(left), ay = fy - static_cast<float>(top);
        const int middle = std::clamp(static_cast<int>(std::lrint(u.at(x, y))), apart, last - apart);
        float h[3];
        for (int k = -1; k <= 1; k++) {
            const auto z = static_cast<unsigned>(middle + k * apart);
            h[k + 1] = (1 - ay) * ((1 - ax) * at(focus, left, top, z) + ax * at(focus, left + 1, top, z)) +
                       ay * ((1 - ax) * at(focus, left, top + 1, z) + ax * at(focus, left + 1, top + 1, z));
        }
        const float own_floor = std::min(floor, (0.8f + 0.2f * t) * std::min({h[0], h[1], h[2]}));
        for (float &value : h)
            value -= own_floor;
        const float highest = std::max({h[0], h[1], h[2], 1.0f / 32.0f});
        for (float &value : h)
            value = highest / std::max(value, 0.02f * highest);
        const float bend = h[0] - 2.0f * h[1] + h[2];
        const float vertex = static_cast<float>(middle) +
                             0.5f * static_cast<float>(apart) * (h[0] - h[2]) / std::max(bend, 1e-4f);
        const float position = u.at(x, y);
        const int spacing = std::min(2 * static_cast<int>(factor), 8);
        float least = position, greatest = position;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                least = std::min(least, at(u, x + i * spacing, y + j * spacing));
                greatest = std::max(greatest, at(u, x + i * spacing, y + j * spacing));
            }
        if (bend <= 1e-4f || std::abs(vertex - position) > (greatest - least > 1.0f ? 0.25f : 0.5f))
            return position;
        return std::clamp(position + (1.0f - 0.6f * t) * (vertex - position), 0.0f, static_cast<float>(last));
    });
    return like(u, [&](int x, int y, unsigned) {
        float sum = 0.0f, weights = 0.0f;
        for (int j = -2; j <= 2; j++)
            for (int i = -2; i <= 2; i++) {
                const float other = at(placed, x + i, y + j);
                const float weight = std::max(1.0f - std::abs(other - placed.at(x, y)), 0.0f);
                sum += weight * other;
                weights += weight;
            }
        return sum / weights;
    });
}

std::vector<uint16_t> limit_depth(const std::vector<uint16_t> &depth, unsigned width, unsigned height,
                                  unsigned block, float blur_step, unsigned planes)
{
    const float exact =
        1.5f * 2.0f * static_cast<float>(block) / blur_step * 65534.0f / static_cast<float>(planes - 1);
    const float slope = std::floor(exact);
    /* The greatest of what lies before the farthest is the nearest. */
    Volume before(width / block, height / block, 1);
    for (unsigned y = 0; y < before.height * block; y++)
        for (unsigned x = 0; x < before.width * block; x++)
            if (const uint16_t pixel = depth[size_t{y} * width + x]) {
                float &nearest = before.at(x / block, y / block);
                nearest = std::max(nearest, 65535.0f - static_cast<float>(pixel - 1));
            }
    const Volume reached = spread(before, std::min(static_cast<int>(std::ceil(65534.0f / exact)), 64), slope);
    std::vector<uint16_t> limited = depth;
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < before.width * block; x++) {
            uint16_t &pixel = limited[size_t{y} * width + x];
            const unsigned row = std::min(y / block, before.height - 1);
            const float fx = (static_cast<float>(x) + 0.5f) / static_cast<float>(block) - 0.5f;
            const float fy = (static_cast<float>(y % block) + 0.5f) / static_cast<float>(block) - 0.5f +
                             static_cast<float>(row);
            const int left = static_cast<int>(std::floor(fx)), top = static_cast<int>(std::floor(fy));
            const float ax = fx - static_cast<float>(left), ay = fy - static_cast<float>(top);
            const float value =
                65535.0f -
                ((1 - ay) * ((1 - ax) * at(reached, left, top) + ax * at(reached, left + 1, top)) +
                 ay * ((1 - ax) * at(reached, left, top + 1) + ax * at(reached, left + 1, top + 1)));
            const float limit = value + std::floor(0.35f * exact);
            if (pixel > 0 && static_cast<float>(pixel - 1) > limit)
                pixel = static_cast<uint16_t>(std::lround(limit) + 1);
        }
    return limited;
}

} // namespace dff::twin
