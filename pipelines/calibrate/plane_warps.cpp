/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "plane_warps.h"

#include <cmath>

namespace dff {

namespace {

cv::Point2d center_of(const BoardView &view)
{
    return {(view.picture.width - 1) / 2.0, (view.picture.height - 1) / 2.0};
}

/* A corner's place is as sure as its edges are sharp. */
double weight_of(const SeenCorner &corner)
{
    return corner.energy;
}

void gather_corners(const std::vector<BoardView> &views, PlaneWarps &warps)
{
    for (std::size_t v = 0; v < views.size(); v++)
        for (std::size_t k = 0; k < views[v].focus.size(); k++) {
            cv::Point2d sum;
            double weights = 0.0;
            for (std::size_t z = 0; z < warps.planes.size(); z++) {
                const SeenCorner &corner = views[v].planes[z][k];
                sum += weight_of(corner) * warps.planes[z].undo(corner.at - center_of(views[v]));
                weights += weight_of(corner);
            }
            warps.corners[v][k] = sum / weights + center_of(views[v]);
        }
}

/* The least squares of S q + d = p. */
PlaneSimilarity fit(const std::vector<BoardView> &views, const PlaneWarps &warps, std::size_t z)
{
    cv::Matx44d normal = cv::Matx44d::zeros();
    cv::Vec4d right;
    for (std::size_t v = 0; v < views.size(); v++)
        for (std::size_t k = 0; k < views[v].focus.size(); k++) {
            const SeenCorner &corner = views[v].planes[z][k];
            const cv::Point2d q = warps.corners[v][k] - center_of(views[v]),
                              p = corner.at - center_of(views[v]);
            const cv::Vec4d x(q.x, -q.y, 1.0, 0.0), y(q.y, q.x, 0.0, 1.0);
            normal += weight_of(corner) * (x * x.t() + y * y.t());
            right += weight_of(corner) * (x * p.x + y * p.y);
        }
    cv::Vec4d result;
    if (!cv::solve(normal, right, result, cv::DECOMP_CHOLESKY))
        throw std::runtime_error("Plane " + std::to_string(z) +
                                 " shows the board in no view: is the lens moving?");
    return {result[0], result[1], result[2], result[3]};
}

/* The warp that first undoes `middle`. */
PlaneSimilarity after_undoing(const PlaneSimilarity &plane, const PlaneSimilarity &middle)
{
    const cv::Point2d shift = plane.apply(middle.undo({0.0, 0.0}));
    const cv::Point2d unit = plane.apply(middle.undo({1.0, 0.0})) - shift;
    return {unit.x, unit.y, shift.x, shift.y};
}

void measure_residuals(const std::vector<BoardView> &views, PlaneWarps &warps)
{
    double sum = 0.0, weights = 0.0;
    for (std::size_t z = 0; z < warps.planes.size(); z++) {
        cv::Point2d offset;
        double plane_weights = 0.0;
        for (std::size_t v = 0; v < views.size(); v++)
            for (std::size_t k = 0; k < views[v].focus.size(); k++) {
                const SeenCorner &corner = views[v].planes[z][k];
                const cv::Point2d left = corner.at - center_of(views[v]) -
                                         warps.planes[z].apply(warps.corners[v][k] - center_of(views[v]));
                sum += weight_of(corner) * left.ddot(left) / 2.0;
                offset += weight_of(corner) * left;
                plane_weights += weight_of(corner);
            }
        weights += plane_weights;
        warps.offsets.push_back(offset / plane_weights);
    }
    warps.residual_px = std::sqrt(sum / weights);
}

PlaneWarps start(const std::vector<BoardView> &views, std::vector<PlaneSimilarity> planes)
{
    PlaneWarps warps{.planes = std::move(planes), .corners = {}, .offsets = {}};
    for (const BoardView &view : views)
        warps.corners.emplace_back(view.focus.size());
    return warps;
}

} // namespace

cv::Point2d PlaneSimilarity::undo(cv::Point2d p) const
{
    const double square = cosine * cosine + sine * sine;
    p -= {dx, dy};
    return {(cosine * p.x + sine * p.y) / square, (cosine * p.y - sine * p.x) / square};
}

PlaneWarps find_warps(const std::vector<BoardView> &views)
{
    constexpr int rounds = 30;
    PlaneWarps warps = start(views, std::vector<PlaneSimilarity>(views.front().planes.size()));
    for (int round = 0; round < rounds; round++) {
        gather_corners(views, warps);
        for (std::size_t z = 0; z < warps.planes.size(); z++)
            warps.planes[z] = fit(views, warps, z);
        const PlaneSimilarity middle = warps.planes[warps.planes.size() / 2];
        for (PlaneSimilarity &plane : warps.planes)
            plane = after_undoing(plane, middle);
    }
    gather_corners(views, warps);
    measure_residuals(views, warps);
    return warps;
}

std::vector<double> left_of_views(const std::vector<BoardView> &views, const PlaneWarps &warps)
{
    std::vector<double> result;
    for (std::size_t v = 0; v < views.size(); v++) {
        double sum = 0.0, weights = 0.0;
        for (std::size_t z = 0; z < warps.planes.size(); z++)
            for (std::size_t k = 0; k < views[v].focus.size(); k++) {
                const SeenCorner &corner = views[v].planes[z][k];
                const cv::Point2d left = corner.at - center_of(views[v]) -
                                         warps.planes[z].apply(warps.corners[v][k] - center_of(views[v]));
                sum += weight_of(corner) * left.ddot(left) / 2.0;
                weights += weight_of(corner);
            }
        result.push_back(std::sqrt(sum / weights));
    }
    return result;
}

PlaneWarps apply_warps(const std::vector<BoardView> &views, std::vector<PlaneSimilarity> planes)
{
    PlaneWarps warps = start(views, std::move(planes));
    gather_corners(views, warps);
    measure_residuals(views, warps);
    return warps;
}

} // namespace dff
