/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/warp_solver.h"

#include <array>

namespace dff {
namespace {

constexpr int unknowns_a_plane = 4;
constexpr int rounds = 6;

/* Pixels. Points spread by about this much around the common similarity; the wider tail is points that wander
 * with the blur of an edge. */
constexpr double cauchy_scale = 0.07;

/* Of a tie between neighbours at each corner: enough to decide where no point does, too little to be felt
 * elsewhere. */
constexpr double tie_weight = 1e-3;

int column_of(std::size_t plane)
{
    return unknowns_a_plane * static_cast<int>(plane);
}

/* The normal equations of the least-squares problem. */
class NormalEquations {
public:
    explicit NormalEquations(std::size_t planes)
        : matrix_(cv::Mat1d::zeros(column_of(planes), column_of(planes))),
          right_(cv::Mat1d::zeros(column_of(planes), 1))
    {
    }

    /* weight * |A_i p - A_j q|^2 */
    void add(std::size_t i, cv::Point2d p, std::size_t j, cv::Point2d q, double weight)
    {
        const std::array<double, 8> x{p.x, -p.y, 1.0, 0.0, -q.x, q.y, -1.0, 0.0};
        const std::array<double, 8> y{p.y, p.x, 0.0, 1.0, -q.y, -q.x, 0.0, -1.0};
        const std::array<int, 2> base{column_of(i), column_of(j)};

        for (int r = 0; r < 8; r++) {
            for (int c = 0; c < 8; c++)
                matrix_(base[r / 4] + r % 4, base[c / 4] + c % 4) += weight * (x[r] * x[c] + y[r] * y[c]);
        }
    }

    /* Makes A_plane the identity, whose first number is 1 and the others 0. */
    void fix(std::size_t plane)
    {
        const int first = column_of(plane);
        right_ -= matrix_.col(first);

        const cv::Range range(first, first + unknowns_a_plane);
        matrix_.rowRange(range).setTo(0.0);
        matrix_.colRange(range).setTo(0.0);
        matrix_(range, range) = cv::Mat1d::eye(unknowns_a_plane, unknowns_a_plane);
        right_.rowRange(range).setTo(0.0);
        right_(first) = 1.0;
    }

    std::vector<PlaneWarp> solve() const
    {
        cv::Mat1d solution;
        std::vector<PlaneWarp> warps;

        cv::solve(matrix_, right_, solution, cv::DECOMP_CHOLESKY);
        for (int i = 0; i < solution.rows; i += unknowns_a_plane)
            warps.push_back({solution(i), solution(i + 1), solution(i + 2), solution(i + 3)});
        return warps;
    }

private:
    cv::Mat1d matrix_;
    cv::Mat1d right_;
};

/* Without warps from the round before, every point counts the same. */
void add_link(NormalEquations &equations, const PlaneLink &link, std::span<const PlaneWarp> warps)
{
    for (std::size_t i = 0; i < link.match.from.size(); i++) {
        const cv::Point2d p = link.match.from[i], q = link.match.to[i];
        double weight = 1.0;

        if (!warps.empty()) {
            const double miss = cv::norm(warps[link.from].apply(p) - warps[link.to].apply(q)) / cauchy_scale;
            weight = 1.0 / (1.0 + miss * miss);
        }
        equations.add(link.from, p, link.to, q, weight);
    }
}

void tie_neighbours(NormalEquations &equations, std::size_t planes, cv::Size size)
{
    const double x = size.width / 2.0, y = size.height / 2.0;

    for (std::size_t z = 0; z + 1 < planes; z++) {
        for (const cv::Point2d corner : {cv::Point2d{-x, -y}, {x, -y}, {-x, y}, {x, y}})
            equations.add(z, corner, z + 1, corner, tie_weight);
    }
}

} // namespace

std::vector<PlaneWarp> solve_warps(std::size_t planes, std::size_t reference,
                                   std::span<const PlaneLink> links, cv::Size size)
{
    std::vector<PlaneWarp> warps;

    for (int i = 0; i < rounds; i++) {
        NormalEquations equations(planes);
        for (const PlaneLink &link : links)
            add_link(equations, link, warps);
        tie_neighbours(equations, planes, size);
        equations.fix(reference);
        warps = equations.solve();
    }
    return warps;
}

} // namespace dff
