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
    std::map<Place, size_t> cells;
    std::vector<size_t> cell_of_pixel;
    std::vector<std::vector<size_t>> neighbours;
};

Grid build_grid(const std::vector<uint8_t> &luma, const std::vector<uint8_t> &u,
                const std::vector<uint8_t> &v, unsigned width, unsigned height,
                const BilateralGrid::Parameters &p)
{
    Grid grid;
    std::map<Place, size_t> &cells = grid.cells;
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

/* A y = b + EPSILON t0 of bilateral_grid.cl over the occupied cells. */
struct Problem {
    Problem(const Grid &grid, const std::vector<uint8_t> &sparse, double lambda)
        : grid(grid), lambda(lambda), weight(grid.neighbours.size()), target(weight.size()),
          n(weight.size(), 1.0)
    {
        Vector mass(weight.size());
        for (size_t pixel = 0; pixel < sparse.size(); pixel++) {
            const size_t cell = grid.cell_of_pixel[pixel];
            mass[cell] += 1.0;
            if (sparse[pixel] != 255) {
                weight[cell] += 1.0;
                target[cell] += 0.5 * sparse[pixel];
            }
        }
        for (int step = 0; step < 10; step++) {
            const Vector b = blurred(grid, n);
            for (size_t i = 0; i < n.size(); i++)
                n[i] = std::sqrt(n[i] * mass[i] / b[i]);
        }
        smooth = product(n, blurred(grid, n));
        mean_target = std::accumulate(target.begin(), target.end(), 0.0) /
                      std::accumulate(weight.begin(), weight.end(), 0.0);
    }

    /* A v */
    Vector system(const Vector &v) const
    {
        const Vector b = product(n, blurred(grid, product(n, v)));
        Vector result(v.size());
        for (size_t i = 0; i < v.size(); i++)
            result[i] = lambda * (smooth[i] * v[i] - b[i]) + (weight[i] + 1e-6) * v[i];
        return result;
    }

    Vector residual(const Vector &y) const
    {
        Vector result = system(y);
        for (size_t i = 0; i < y.size(); i++)
            result[i] = target[i] + 1e-6 * mean_target - result[i];
        return result;
    }

    double diagonal(size_t i) const { return lambda * (smooth[i] - 10.0 * n[i] * n[i]) + weight[i] + 1e-6; }

    const Grid &grid;
    double lambda;
    Vector weight, target, n, smooth;
    double mean_target;
};

/* With Jacobi's preconditioner. */
Vector conjugate_gradient(const Problem &problem, Vector solution, unsigned iterations)
{
    const size_t cells = solution.size();
    Vector residual = problem.residual(solution), scaled(cells);
    const auto scale = [&] {
        for (size_t i = 0; i < cells; i++)
            scaled[i] = residual[i] / std::max(problem.diagonal(i), 1e-5);
    };
    scale();
    Vector direction = scaled;
    for (unsigned step = 0; step < iterations; step++) {
        const Vector applied = problem.system(direction);
        const double before = dot(residual, scaled);
        if (before == 0.0)
            break;
        const double alpha = before / dot(direction, applied);
        for (size_t i = 0; i < cells; i++) {
            solution[i] += alpha * direction[i];
            residual[i] -= alpha * applied[i];
        }
        scale();
        const double beta = dot(residual, scaled) / before;
        for (size_t i = 0; i < cells; i++)
            direction[i] = scaled[i] + beta * direction[i];
    }
    return solution;
}

Volume sliced(const Vector &solution, const Grid &grid, unsigned width, unsigned height)
{
    Volume u(width, height, 1);
    for (size_t pixel = 0; pixel < u.values.size(); pixel++)
        u.values[pixel] = static_cast<float>(solution[grid.cell_of_pixel[pixel]]);
    return u;
}

} // namespace

Volume bilateral_solve(const std::vector<uint8_t> &sparse, const std::vector<uint8_t> &reference_y,
                       const std::vector<uint8_t> &reference_u, const std::vector<uint8_t> &reference_v,
                       unsigned width, unsigned height, const BilateralGrid::Parameters &parameters)
{
    const Grid grid = build_grid(reference_y, reference_u, reference_v, width, height, parameters);
    const Problem problem(grid, sparse, parameters.lambda);
    Vector start(grid.neighbours.size());
    for (size_t i = 0; i < start.size(); i++)
        start[i] = problem.weight[i] > 0.0 ? problem.target[i] / problem.weight[i] : problem.mean_target;
    return sliced(conjugate_gradient(problem, start, parameters.iterations), grid, width, height);
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
            cells[cell_of(pixel)].first += 0.5 * sparse[pixel];
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

/* The picture's pixel values, one a cell. */
static Vector gathered(const Volume &picture, const Grid &grid)
{
    Vector cells(grid.neighbours.size());
    for (size_t pixel = 0; pixel < picture.values.size(); pixel++)
        cells[grid.cell_of_pixel[pixel]] = picture.values[pixel];
    return cells;
}

Continued solve_from_better_start(const std::vector<uint8_t> &sparse, const std::vector<uint8_t> &luma,
                                  const Volume &last, const std::vector<uint8_t> &last_luma,
                                  const BilateralGrid::Parameters &parameters)
{
    const Grid grid = build_grid(luma, {}, {}, last.width, last.height, parameters);
    const Grid last_grid = build_grid(last_luma, {}, {}, last.width, last.height, parameters);
    const Vector last_solution = gathered(last, last_grid);
    const Vector spread = gathered(spread_start(sparse, luma, last.width, last.height, parameters), grid);
    Vector continued = spread;
    for (const auto &[place, cell] : grid.cells)
        if (const auto before = last_grid.cells.find(place); before != last_grid.cells.end())
            continued[cell] = last_solution[before->second];

    const Problem problem(grid, sparse, parameters.lambda);
    const auto squared_residual = [&](const Vector &start) {
        const Vector residual = problem.residual(start);
        double sum = 0.0;
        for (size_t i = 0; i < residual.size(); i++)
            sum += residual[i] * residual[i] / problem.diagonal(i);
        return sum;
    };
    const double of_spread = squared_residual(spread), of_continued = squared_residual(continued);
    const Vector &better = of_continued < of_spread ? continued : spread;
    return {sliced(conjugate_gradient(problem, better, parameters.iterations), grid, last.width, last.height),
            of_continued / of_spread};
}

} // namespace dff::twin
