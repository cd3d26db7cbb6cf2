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

} // namespace dff::twin
