/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "twin_bilateral_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace dff::twin {

namespace {

using Vector = std::vector<double>;
using Place = std::array<int, 5>; /* x, y, Y, U, V */

struct Grid {
    std::vector<size_t> cell_of_pixel;
    std::vector<std::vector<size_t>> neighbours;
};

Grid build_grid(const std::vector<uint8_t> &luma, const std::vector<uint8_t> &u,
                const std::vector<uint8_t> &v, unsigned width, unsigned height,
                const BilateralGrid::Parameters &p)
{
    Grid grid;
    std::map<Place, size_t> cells;
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++) {
            const size_t pixel = size_t{y} * width + x;
            const auto chroma = static_cast<int>(p.sigma_chroma);
            const Place place{static_cast<int>(x / p.sigma_xy), static_cast<int>(y / p.sigma_xy),
                              static_cast<int>(luma[pixel] / p.sigma_luma), chroma ? u[pixel] / chroma : 0,
                              chroma ? v[pixel] / chroma : 0};
            grid.cell_of_pixel.push_back(cells.try_emplace(place, cells.size()).first->second);
        }
    grid.neighbours.resize(cells.size());
    for (const auto &[place, cell] : cells)
        for (size_t axis = 0; axis < place.size(); axis++)
            for (const int step : {-1, 1}) {
                Place beside = place;
                beside[axis] += step;
                if (const auto found = cells.find(beside); found != cells.end())
                    grid.neighbours[cell].push_back(found->second);
            }
    return grid;
}

Vector blurred(const Grid &grid, const Vector &v)
{
    Vector result(v.size());
    for (size_t i = 0; i < v.size(); i++) {
        result[i] = 10.0 * v[i];
        for (const size_t j : grid.neighbours[i])
            result[i] += v[j];
    }
    return result;
}

Vector product(const Vector &a, const Vector &b)
{
    Vector result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::multiplies<>());
    return result;
}

double dot(const Vector &a, const Vector &b)
{
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

} // namespace

Volume bilateral_solve(const std::vector<uint8_t> &sparse, const std::vector<uint8_t> &reference_y,
                       const std::vector<uint8_t> &reference_u, const std::vector<uint8_t> &reference_v,
                       unsigned width, unsigned height, const BilateralGrid::Parameters &parameters)
{
    const Grid grid = build_grid(reference_y, reference_u, reference_v, width, height, parameters);
    const size_t cells = grid.neighbours.size();
    Vector mass(cells), weight(cells), target(cells), n(cells, 1.0);
    for (size_t pixel = 0; pixel < sparse.size(); pixel++) {
        const size_t cell = grid.cell_of_pixel[pixel];
        mass[cell] += 1.0;
        if (sparse[pixel] != 255) {
            weight[cell] += 1.0;
            target[cell] += sparse[pixel];
        }
    }

    for (int step = 0; step < 10; step++) {
        const Vector b = blurred(grid, n);
        for (size_t i = 0; i < cells; i++)
            n[i] = std::sqrt(n[i] * mass[i] / b[i]);
    }
    const Vector smooth = product(n, blurred(grid, n));
    const auto system = [&](const Vector &v) {
        const Vector b = product(n, blurred(grid, product(n, v)));
        Vector result(cells);
        for (size_t i = 0; i < cells; i++)
            result[i] = parameters.lambda * (smooth[i] * v[i] - b[i]) + (weight[i] + 1e-6) * v[i];
        return result;
    };

    const double mean_target = std::accumulate(target.begin(), target.end(), 0.0) /
                               std::accumulate(weight.begin(), weight.end(), 0.0);
    Vector solution(cells), diagonal(cells), residual(cells);
    for (size_t i = 0; i < cells; i++) {
        solution[i] = weight[i] > 0.0 ? target[i] / weight[i] : mean_target;
        diagonal[i] = std::max(parameters.lambda * (smooth[i] - 10.0 * n[i] * n[i]) + weight[i] + 1e-6, 1e-5);
    }
    const Vector start = system(solution);
    Vector direction(cells);
    for (size_t i = 0; i < cells; i++) {
        residual[i] = target[i] + 1e-6 * mean_target - start[i];
        direction[i] = residual[i] / diagonal[i];
    }
    Vector scaled = direction;
    for (unsigned step = 0; step < parameters.iterations; step++) {
        const Vector applied = system(direction);
        const double before = dot(residual, scaled);
        if (before == 0.0)
            break;
        const double alpha = before / dot(direction, applied);
        for (size_t i = 0; i < cells; i++) {
            solution[i] += alpha * direction[i];
            residual[i] -= alpha * applied[i];
            scaled[i] = residual[i] / diagonal[i];
        }
        const double beta = dot(residual, scaled) / before;
        for (size_t i = 0; i < cells; i++)
            direction[i] = scaled[i] + beta * direction[i];
    }

    Volume u(width, height, 1);
    for (size_t pixel = 0; pixel < sparse.size(); pixel++)
        u.values[pixel] = static_cast<float>(solution[grid.cell_of_pixel[pixel]]);
    return u;
}

/* What of a cell arrives at another when each of `cells` passes 0.6 of its own on to the right, then to the
 * left. */
static double spread(int from, int to, int cells)
{
    double sum = 0.0;
    for (int turn = std::max(from, to); turn < cells; turn++)
        sum += std::pow(0.6, turn - from) * std::pow(0.6, turn - to);
    return sum;
}

Volume spread_start(const std::vector<uint8_t> &sparse, const std::vector<uint8_t> &luma, unsigned width,
                    unsigned height, const BilateralGrid::Parameters &p)
{
    std::map<std::array<int, 3>, std::pair<double, double>> cells; /* sum of planes, known pixels */
    const auto cell_of = [&](size_t pixel) {
        return std::array{static_cast<int>(pixel % width / p.sigma_xy),
                          static_cast<int>(pixel / width / p.sigma_xy),
                          static_cast<int>(luma[pixel] / p.sigma_luma)};
    };
    for (size_t pixel = 0; pixel < sparse.size(); pixel++)
        if (sparse[pixel] != 255) {
            cells[cell_of(pixel)].first += sparse[pixel];
            cells[cell_of(pixel)].second += 1.0;
        }

    const int columns = static_cast<int>((width - 1) / p.sigma_xy) + 1;
    const int rows = static_cast<int>((height - 1) / p.sigma_xy) + 1;
    Volume start(width, height, 1);
    std::map<std::array<int, 3>, double> means;
    for (size_t pixel = 0; pixel < sparse.size(); pixel++) {
        const auto here = cell_of(pixel);
        if (!means.contains(here)) {
            double target = 0.0, weight = 0.0;
            for (const auto &[there, known] : cells) {
                const int steps = std::abs(here[2] - there[2]);
                if (steps > 1)
                    continue;
                const double nearness = std::pow(0.4, steps) * spread(here[0], there[0], columns) *
                                        spread(here[1], there[1], rows);
                target += nearness * known.first;
                weight += nearness * known.second;
            }
            means[here] = target / weight;
        }
        start.values[pixel] = static_cast<float>(means[here]);
    }
    return start;
}

} // namespace dff::twin
