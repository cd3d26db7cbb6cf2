/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focus_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dff {

namespace {

std::vector<double> energies_of(const BoardView &view, std::size_t corner)
{
    std::vector<double> energies;
    for (const auto &plane : view.planes)
        energies.push_back(plane[corner].energy);
    return energies;
}

/* Widths of an edge that is in focus: the smoothing, the pixel, and the difference that makes the gradient.
 */
double sharpest_variance()
{
    constexpr double pixel = 1.0 / 12.0, difference = 1.0 / 3.0, across = 0.25;
    return BoardView::smoothing * BoardView::smoothing + pixel + difference + across;
}

double model_energy(double off, double window, double blur_step)
{
    const double disk = blur_step * off / 4.0; /* the deviation of a disk along an axis */
    const double width = std::sqrt(sharpest_variance() + disk * disk);
    return std::max(1.0 / width - std::numbers::inv_sqrtpi * 2.0 / (window + 0.5), 0.0);
}

/* What is left of the energies, the scale of the model being free. */
double left_by(std::span<const double> energies, double vertex, double window, double blur_step)
{
    double mm = 0.0, my = 0.0, yy = 0.0;
    for (std::size_t z = 0; z < energies.size(); z++) {
        if (energies[z] <= 0.0)
            continue;
        const double m = model_energy(static_cast<double>(z) - vertex, window, blur_step);
        mm += m * m;
        my += m * energies[z];
        yy += energies[z] * energies[z];
    }
    return mm > 0.0 ? yy - my * my / mm : yy;
}

struct CornerOfView {
    const BoardView *view;
    std::size_t corner;
};

/* Corners that are sharpest between the ends of the sweep, or all if there are none; not more than are
 * needed. */
std::vector<CornerOfView> telling_corners(const std::vector<BoardView> &views)
{
    constexpr std::size_t every = 5;
    std::vector<CornerOfView> all, within;
    for (const BoardView &view : views)
        for (std::size_t k = 0; k < view.corners.size(); k += every) {
            const std::vector<double> energies = energies_of(view, k);
            const auto sharpest = std::max_element(energies.begin(), energies.end());
            all.push_back({&view, k});
            if (sharpest != energies.begin() && sharpest != energies.end() - 1)
                within.push_back({&view, k});
        }
    return within.empty() ? all : within;
}

/* How many planes beside the sharpest one have edges not much wider than a disk's model holds for. */
double reach_of(double blur_step)
{
    constexpr double widest_px = 4.0;
    return std::max(1.0, std::floor(widest_px / blur_step));
}

std::vector<double> energies_near_focus(const BoardView &view, std::size_t corner, double reach)
{
    std::vector<double> energies = energies_of(view, corner);
    const auto sharpest = std::max_element(energies.begin(), energies.end()) - energies.begin();
    for (std::size_t z = 0; z < energies.size(); z++)
        if (std::abs(static_cast<double>(z) - static_cast<double>(sharpest)) > reach)
            energies[z] = 0.0;
    return energies;
}

/* The blur step that leaves least of the energies of so many planes. */
double best_blur_step(const std::vector<BoardView> &views, double reach)
{
    constexpr double finest = 0.2, most = 30.0, growth = 1.03, no_curve = 0.05;
    const std::vector<CornerOfView> corners = telling_corners(views);
    double best = finest, least = INFINITY;
    for (double blur_step = finest; blur_step < most; blur_step *= growth) {
        double sum = 0.0;
        for (const auto &[view, k] : corners) {
            const auto curve = fit_curve(energies_near_focus(*view, k, reach), view->window, blur_step);
            sum += curve ? std::min(curve->residual, no_curve) : no_curve;
        }
        if (sum < least) {
            least = sum;
            best = blur_step;
        }
    }
    return best;
}

/* Planes in which a blur reaches a corner's neighbours say nothing of it. */
void forget_blurred(BoardView &view, std::size_t corner, double sharpest, double blur_step)
{
    for (std::size_t z = 0; z < view.planes.size(); z++)
        if (blur_step * std::abs(static_cast<double>(z) - sharpest) > view.window)
            view.planes[z][corner].energy = 0.0;
}

} // namespace

std::optional<FocusCurve> fit_curve(std::span<const double> energies, double window, double blur_step)
{
    constexpr double beyond = 0.5, coarse = 0.05, fine = 0.0025; /* planes */
    const auto seen =
        std::count_if(energies.begin(), energies.end(), [](double energy) { return energy > 0.0; });
    const double last = static_cast<double>(energies.size()) - 1.0;
    const double largest = *std::max_element(energies.begin(), energies.end());
    if (seen < 2)
        return std::nullopt;
    FocusCurve best{NAN, INFINITY};
    const auto look = [&](double from, double to, double step) {
        for (double vertex = from; vertex <= to; vertex += step)
            if (const double left = left_by(energies, vertex, window, blur_step) / (largest * largest);
                left < best.residual)
                best = {vertex, left};
    };
    look(-beyond, last + beyond, coarse);
    look(best.vertex - coarse, best.vertex + coarse, fine);
    const bool within = best.vertex > -beyond && best.vertex < last + beyond;
    return within ? std::optional(best) : std::nullopt;
}

double find_blur_step(const std::vector<BoardView> &views)
{
    const double first = best_blur_step(views, 2.0);
    return reach_of(first) == 2.0 ? first : best_blur_step(views, reach_of(first));
}

double find_focus(std::vector<BoardView> &views)
{
    const double blur_step = find_blur_step(views);
    for (BoardView &view : views)
        for (std::size_t k = 0; k < view.corners.size(); k++) {
            const std::vector<double> all = energies_of(view, k);
            const auto sharpest = std::max_element(all.begin(), all.end()) - all.begin();
            forget_blurred(view, k, static_cast<double>(sharpest), blur_step);
            const auto curve =
                fit_curve(energies_near_focus(view, k, reach_of(blur_step)), view.window, blur_step);
            view.focus[k] = curve ? curve->vertex : NAN;
        }
    return blur_step;
}

} // namespace dff
