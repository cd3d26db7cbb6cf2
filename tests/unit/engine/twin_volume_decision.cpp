/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "twin_volume.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace dff::twin {

namespace {

using Place = std::array<int, 2>; /* x, y */
using Vector3 = std::array<double, 3>;

int clamped(int i, unsigned n)
{
    return std::clamp(i, 0, static_cast<int>(n) - 1);
}

/* Ends repeated: -1 is 0. */
int reflect(int i, unsigned n)
{
    return clamped(i < 0 ? -1 - i : i < static_cast<int>(n) ? i : 2 * static_cast<int>(n) - 1 - i, n);
}

float difference(const Colours &guide, Place p, Place q)
{
    float sum = 0.0f;
    for (const Volume &colour : guide)
        sum += std::abs(colour.at(p[0], p[1]) - colour.at(q[0], q[1]));
    return sum;
}

/* Cramer's rule for a symmetric matrix. */
Vector3 solve(const std::array<Vector3, 3> &m, const Vector3 &v)
{
    const auto determinant = [](const std::array<Vector3, 3> &a) {
        return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
               a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
               a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    };
    Vector3 result;
    for (size_t column = 0; column < 3; column++) {
        std::array<Vector3, 3> replaced = m;
        for (size_t row = 0; row < 3; row++)
            replaced[row][column] = v[row];
        result[column] = determinant(replaced) / determinant(m);
    }
    return result;
}

/* Calls work(x, y, weight) over the window of the guided filter, weights summing to 1. */
template <typename Work> void over_window(const Volume &v, int x, int y, float t, const Work &work)
{
    const double rim = t > 0.1f ? t : 0.0, side = 3.0 + 2.0 * rim;
    for (int j = -2; j <= 2; j++)
        for (int i = -2; i <= 2; i++) {
            const double weight =
                (std::abs(i) == 2 ? rim : 1.0) * (std::abs(j) == 2 ? rim : 1.0) / (side * side);
            work(reflect(x + i, v.width), reflect(y + j, v.height), weight);
        }
}

/* One path's L over the whole picture, added to total. */
void follow(const Volume &cost, const Colours &guide, Place step, float p1, float p2, Volume &total)
{
    Volume path(cost.width, cost.height, cost.planes);
    const int width = static_cast<int>(cost.width), height = static_cast<int>(cost.height);
    const int planes = static_cast<int>(cost.planes);
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++) {
            const int y = step[1] < 0 ? height - 1 - row : row, x = step[0] < 0 ? width - 1 - column : column;
            const int qx = x - step[0], qy = y - step[1];
            const bool enters = qx < 0 || qx >= width || qy < 0 || qy >= height;
            const float e = enters ? 0.0f : std::exp(-difference(guide, {x, y}, {qx, qy}) / 15.0f) + 0.01f;
            float least = std::numeric_limits<float>::infinity();
            for (int z = 0; z < planes && !enters; z++)
                least = std::min(least, path.at(qx, qy, z));
            for (int z = 0; z < planes; z++) {
                float best = 0.0f;
                if (!enters) {
                    best = std::min(path.at(qx, qy, z), least + p2 * e);
                    if (z > 0)
                        best = std::min(best, path.at(qx, qy, z - 1) + p1 * e);
                    if (z + 1 < planes)
                        best = std::min(best, path.at(qx, qy, z + 1) + p1 * e);
                    best -= least;
                }
                path.at(x, y, z) = cost.at(x, y, z) + best;
                total.at(x, y, z) += path.at(x, y, z);
            }
        }
}

/* (1 + lambda L) x = f along one line, by Gauss's elimination of the tridiagonal system. */
std::vector<double> smooth_line(const std::vector<double> &f, const std::vector<double> &affinity,
                                double lambda)
{
    const size_t n = f.size();
    std::vector<double> diagonal(n, 1.0), x = f;
    for (size_t i = 1; i < n; i++) {
        diagonal[i] += lambda * affinity[i];
        diagonal[i - 1] += lambda * affinity[i];
    }
    for (size_t i = 1; i < n; i++) {
        const double factor = lambda * affinity[i] / diagonal[i - 1];
        diagonal[i] -= factor * lambda * affinity[i];
        x[i] += factor * x[i - 1];
    }
    x[n - 1] /= diagonal[n - 1];
    for (size_t i = n - 1; i-- > 0;)
        x[i] = (x[i] + lambda * affinity[i + 1] * x[i + 1]) / diagonal[i];
    return x;
}

void smooth(Volume &picture, const Colours &guide, double lambda, bool along_rows)
{
    const unsigned lines = along_rows ? picture.height : picture.width,
                   n = along_rows ? picture.width : picture.height;
    for (unsigned line = 0; line < lines; line++) {
        const auto place = [&](unsigned i) {
            return along_rows ? Place{static_cast<int>(i), static_cast<int>(line)}
                              : Place{static_cast<int>(line), static_cast<int>(i)};
        };
        std::vector<double> f(n), affinity(n, 0.0);
        for (unsigned i = 0; i < n; i++) {
            f[i] = picture.at(place(i)[0], place(i)[1]);
            if (i > 0)
                affinity[i] = std::exp(-difference(guide, place(i), place(i - 1)) / 3.0);
        }
        const std::vector<double> x = smooth_line(f, affinity, lambda);
        for (unsigned i = 0; i < n; i++)
            picture.at(place(i)[0], place(i)[1]) = static_cast<float>(x[i]);
    }
}

} // namespace

Volume guided_filter(const Volume &cost, const Colours &guide, float t)
{
    Volume result = cost;
    std::array<Volume, 4> fitted{result, result, result, result};
    for (unsigned z = 0; z < cost.planes; z++)
        for (int y = 0; y < static_cast<int>(cost.height); y++)
            for (int x = 0; x < static_cast<int>(cost.width); x++) {
                Vector3 mean{}, with_cost{};
                std::array<Vector3, 3> covariance{};
                double mean_cost = 0.0;
                over_window(cost, x, y, t, [&](int i, int j, double weight) {
                    mean_cost += weight * cost.at(i, j, z);
                    for (size_t a = 0; a < 3; a++) {
                        mean[a] += weight * guide[a].at(i, j);
                        with_cost[a] += weight * guide[a].at(i, j) * cost.at(i, j, z);
                        for (size_t b = 0; b < 3; b++)
                            covariance[a][b] += weight * guide[a].at(i, j) * guide[b].at(i, j);
                    }
                });
                for (size_t a = 0; a < 3; a++) {
                    with_cost[a] -= mean[a] * mean_cost;
                    for (size_t b = 0; b < 3; b++)
                        covariance[a][b] += (a == b ? 30.0 : 0.0) - mean[a] * mean[b];
                }
                const Vector3 slope = solve(covariance, with_cost);
                for (size_t a = 0; a < 3; a++) {
                    fitted[a].at(x, y, z) = static_cast<float>(slope[a]);
                    mean_cost -= slope[a] * mean[a];
                }
                fitted[3].at(x, y, z) = static_cast<float>(mean_cost);
            }
    for (unsigned z = 0; z < cost.planes; z++)
        for (int y = 0; y < static_cast<int>(cost.height); y++)
            for (int x = 0; x < static_cast<int>(cost.width); x++) {
                double value = 0.0;
                over_window(cost, x, y, t, [&](int i, int j, double weight) {
                    for (size_t a = 0; a < 3; a++)
                        value += weight * fitted[a].at(i, j, z) * guide[a].at(x, y);
                    value += weight * fitted[3].at(i, j, z);
                });
                result.at(x, y, z) = static_cast<float>(value);
            }
    return result;
}

Volume doubt_nearer(const Volume &filtered, const Volume &nearer, float t)
{
    Volume result = filtered;
    for (unsigned y = 0; y < filtered.height; y++)
        for (unsigned x = 0; x < filtered.width; x++) {
            unsigned best = 0;
            for (unsigned z = 1; z < filtered.planes; z++)
                if (filtered.at(x, y, z) < filtered.at(x, y, best))
                    best = z;
            const float doubt = std::clamp(nearer.at(x, y) - static_cast<float>(best) - 1.0f, 0.0f, 1.0f);
            for (unsigned z = 0; z < filtered.planes; z++)
                result.at(x, y, z) *= 1.0f - (1.0f - t) * doubt;
        }
    return result;
}

namespace {

/* Whether nothing from p on, one step after the other, is lower before something is higher by `rise`; where
 * that is, or beyond the end. */
std::pair<bool, int> rises(const std::vector<float> &cost, int p, int step, float rise)
{
    const int count = static_cast<int>(cost.size());
    for (int q = p + step; q >= 0 && q < count; q += step) {
        if (cost[q] < cost[p] || (step < 0 && cost[q] == cost[p]))
            return {false, q};
        if (cost[q] >= cost[p] + rise)
            return {true, q};
    }
    return {true, step < 0 ? -1 : count};
}

void prefer_first(std::vector<float> &cost, float rise)
{
    const int count = static_cast<int>(cost.size());
    for (int p = 0; p < count; p++) {
        const auto [is_low, end] = rises(cost, p, 1, rise);
        if (!is_low || end == count || !rises(cost, p, -1, rise).first)
            continue;
        bool has_another = false;
        float highest = cost[end];
        for (int i = end; i < count; i++) {
            highest = std::max(highest, cost[i]);
            has_another |= highest - cost[i] >= rise;
        }
        const float floor = cost[p];
        for (int i = 0; has_another && i < count; i++)
            cost[i] = i < end ? std::max(cost[i] - floor, 0.0f) : std::max(cost[i], 1228.0f);
        return;
    }
}

} // namespace

Volume prefer(const Volume &cost, const Volume &top, float median_top, float t, bool from_far)
{
    const float q = (0.4f + 0.35f * t) * median_top + 1.5f + 2.5f * t;
    Volume result = cost;
    for (unsigned y = 0; y < cost.height; y++)
        for (unsigned x = 0; x < cost.width; x++) {
            std::vector<float> along(cost.planes);
            const auto plane = [&](unsigned i) { return from_far ? cost.planes - 1 - i : i; };
            for (unsigned i = 0; i < cost.planes; i++)
                along[i] = cost.at(x, y, plane(i));
            prefer_first(along, std::round(1024.0f * q / (top.at(x, y) + q)));
            for (unsigned i = 0; i < cost.planes; i++)
                result.at(x, y, plane(i)) = along[i];
        }
    return result;
}

Volume match(const Volume &cost, const Colours &guide, float t)
{
    Volume total(cost.width, cost.height, cost.planes);
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            if (dx != 0 || dy != 0)
                follow(cost, guide, {dx, dy}, 0.4f + 0.4f * t, 2.0f, total);
    return total;
}

Volume decide(const Volume &total, float t)
{
    Volume u(total.width, total.height, 1);
    const int last = static_cast<int>(total.planes) - 1;
    for (unsigned y = 0; y < u.height; y++)
        for (unsigned x = 0; x < u.width; x++) {
            int best = 0;
            for (int z = 1; z <= last; z++)
                if (total.at(x, y, z) < total.at(x, y, best))
                    best = z;
            float offset = 0.0f;
            if (last > 1) {
                const int middle = std::clamp(best, 1, last - 1);
                const float before = total.at(x, y, middle - 1), after = total.at(x, y, middle + 1);
                const float curvature = before - 2.0f * total.at(x, y, middle) + after;
                if (curvature > 1e-12f)
                    offset = 0.5f * (before - after) / curvature + static_cast<float>(middle - best);
            }
            offset = std::clamp(offset, -0.5f, 0.5f);
            const float pointedness = 2.0f - 1.4f * t;
            offset *= (1.0f + pointedness) / (1.0f + 2.0f * pointedness * std::abs(offset));
            u.at(x, y) = std::clamp(static_cast<float>(best) + offset, 0.0f, static_cast<float>(last));
        }
    return u;
}

Volume mean_over_planes(const Volume &cost)
{
    Volume mean(cost.width, cost.height, 1);
    for (size_t i = 0; i < cost.values.size(); i++)
        mean.values[i % mean.values.size()] += cost.values[i] / static_cast<float>(cost.planes);
    for (float &value : mean.values)
        value = std::clamp(value, 0.0f, 1.0f);
    return mean;
}

Volume fill(const Volume &u, const Volume &confidence, const Colours &guide, float high_confidence, float t,
            float blur_step)
{
    Volume weighted = u, weights = u, result = u;
    for (size_t i = 0; i < u.values.size(); i++) {
        weights.values[i] = confidence.values[i] * confidence.values[i] + 1e-4f;
        weighted.values[i] = weights.values[i] * u.values[i];
    }
    const double stiffness = std::max(1.0 + 5.0 * t, blur_step * blur_step / 64.0);
    for (const double share : {40.0, 10.0}) /* 1.5 * 100 * 4^(1 - i) / (4^2 - 1) */
        for (const bool along_rows : {false, true}) {
            smooth(weighted, guide, share * stiffness, along_rows);
            smooth(weights, guide, share * stiffness, along_rows);
        }
    for (size_t i = 0; i < u.values.size(); i++) {
        const float own = std::min(confidence.values[i] / high_confidence, 1.0f);
        result.values[i] = own * u.values[i] + (1.0f - own) * weighted.values[i] / weights.values[i];
    }
    return result;
}

namespace {

float mirrored(const Volume &v, int x, int y)
{
    return v.at(reflect(x, v.width), reflect(y, v.height));
}

/* The mean of a value over the 3x3 cells around. */
float mean_around(int x, int y, const std::function<float(int, int)> &value)
{
    float sum = 0.0f;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            sum += value(x + i, y + j);
    return sum / 9.0f;
}

} // namespace

Volume deviation(const Volume &u, const Volume &decided, const Volume &matched, const Volume &evidence,
                 float high_confidence, const Volume &cost, float t)
{
    Volume result = u;
    const auto last = static_cast<float>(cost.planes - 1);
    const Volume mean = mean_over_planes(cost);
    for (int y = 0; y < static_cast<int>(u.height); y++)
        for (int x = 0; x < static_cast<int>(u.width); x++) {
            float least = u.at(x, y), most = least;
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++) {
                    least = std::min(least, u.at(reflect(x + i, u.width), reflect(y + j, u.height)));
                    most = std::max(most, u.at(reflect(x + i, u.width), reflect(y + j, u.height)));
                }
            int best = 0;
            for (int z = 1; z < static_cast<int>(cost.planes); z++)
                if (cost.at(x, y, z) < cost.at(x, y, best))
                    best = z;
            float margin = 2.0f;
            for (int z = 0; z < static_cast<int>(cost.planes); z++)
                if (std::abs(z - best) > 1)
                    margin = std::min(margin, cost.at(x, y, z) - cost.at(x, y, best));
            const float share = evidence.at(x, y) / (high_confidence * high_confidence);
            const float rough = mean_around(x, y, [&](int i, int j) {
                const float around = mirrored(u, i - 1, j) + mirrored(u, i + 1, j) + mirrored(u, i, j - 1) +
                                     mirrored(u, i, j + 1);
                return std::abs(around / 4.0f - mirrored(u, i, j));
            });
            const float place = mean_around(x, y, [&](int i, int j) {
                return std::abs(mirrored(decided, i, j) - mirrored(matched, i, j));
            });
            const float power = 2.659f + 0.491f * t + 0.207f * std::log(most - least + 0.05f) +
                                0.296f * std::log(rough + 0.01f) +
                                0.451f * std::log(std::abs(u.at(x, y) - decided.at(x, y)) + 0.03f) +
                                0.514f * std::log(place + 0.02f) -
                                0.343f * std::log(margin / (mean.at(x, y) + 0.02f) + 0.01f) +
                                1.103f * std::max(1.0f - 10.0f * share, 0.0f) -
                                0.401f * std::log(static_cast<float>(cost.planes));
            result.at(x, y) = std::min(std::exp(power), last);
        }
    return result;
}

Volume upsample(const Volume &u, const Colours &guide, const Colours &planes, float t, unsigned scale)
{
    const Volume nearer = nearest_3x3(u);
    const float s = 0.6f + 0.3f * t;
    Volume result(planes[0].width, planes[0].height, 1);
    for (unsigned y = 0; y < result.height; y++)
        for (unsigned x = 0; x < result.width; x++) {
            const float fx = (x + 0.5f) / scale - 0.5f, fy = (y + 0.5f) / scale - 0.5f;
            const int left = static_cast<int>(std::floor(fx)), top = static_cast<int>(std::floor(fy));
            const auto low = [&](const Volume &v, int i, int j) {
                return v.at(reflect(left + i, v.width), reflect(top + j, v.height));
            };
            float least = low(u, 0, 0), most = least;
            for (int k = 0; k < 16; k++) {
                least = std::min(least, low(u, k % 4 - 1, k / 4 - 1));
                most = std::max(most, low(u, k % 4 - 1, k / 4 - 1));
            }
            const float ax = fx - left, ay = fy - top;
            if (most - least < 0.5f) {
                result.at(x, y) = (1 - ay) * ((1 - ax) * low(u, 0, 0) + ax * low(u, 1, 0)) +
                                  ay * ((1 - ax) * low(u, 0, 1) + ax * low(u, 1, 1));
                continue;
            }
            const float position =
                0.25f * (low(nearer, 0, 0) + low(nearer, 1, 0) + low(nearer, 0, 1) + low(nearer, 1, 1));
            Vector3 own{};
            double own_weights = 0.0;
            for (unsigned z = 0; z < planes[0].planes; z++) {
                const float d = static_cast<float>(z) - position;
                if (std::abs(d) > 2.5f * s)
                    continue;
                const double weight = std::exp(-d * d / (2.0f * s * s));
                own_weights += weight;
                for (size_t c = 0; c < 3; c++)
                    own[c] += weight * planes[c].at(x, y, z);
            }
            double sum = 0.0, weights = 0.0;
            for (int k = 0; k < 16; k++) {
                const int i = k % 4 - 1, j = k / 4 - 1;
                double difference = 0.0;
                for (size_t c = 0; c < 3; c++)
                    difference += std::abs(own[c] / own_weights - low(guide[c], i, j));
                const double likeness = std::max(1.0 - difference / 60.0, 0.0);
                const double nearness = std::exp(-((ax - i) * (ax - i) + (ay - j) * (ay - j)) / 4.5);
                const double farness = 1.0 + 4.0 * low(u, i, j) / (planes[0].planes - 1.0);
                const double weight = likeness * likeness * nearness * farness + 1e-5;
                weights += weight;
                sum += weight * low(u, i, j);
            }
            result.at(x, y) = static_cast<float>(sum / weights);
        }
    return result;
}

std::vector<uint8_t> upsample_confidence(const Volume &confidence, unsigned width, unsigned height,
                                         unsigned scale)
{
    std::vector<uint8_t> upsampled;
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++) {
            const double fx = (x + 0.5) / scale - 0.5, fy = (y + 0.5) / scale - 0.5;
            const int left = static_cast<int>(std::floor(fx)), top = static_cast<int>(std::floor(fy));
            double c = 0.0;
            for (int j = 0; j < 2; j++)
                for (int i = 0; i < 2; i++)
                    c += (1.0 - std::abs(left + i - fx)) * (1.0 - std::abs(top + j - fy)) *
                         confidence.at(reflect(left + i, confidence.width),
                                       reflect(top + j, confidence.height));
            upsampled.push_back(static_cast<uint8_t>(std::lround(255.0 * c)));
        }
    return upsampled;
}

std::vector<uint16_t> keep_confident(const std::vector<uint16_t> &depth,
                                     const std::vector<uint8_t> &confidence,
                                     const std::vector<uint8_t> *moved, float high_confidence)
{
    std::vector<uint16_t> kept = depth;
    for (size_t i = 0; i < kept.size(); i++)
        if (confidence[i] / 255.0f < 0.5f * high_confidence || (moved && (*moved)[i]))
            kept[i] = 0;
    return kept;
}

} // namespace dff::twin
