/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "board_view.h"

#include "focus_curves.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

std::vector<cv::Mat1f> mean_planes(const std::vector<Sweep> &sweeps)
{
    std::vector<cv::Mat1f> means;
    for (std::size_t plane = 0; plane < sweeps.front().planes.size(); plane++) {
        cv::Mat1f sum(sweeps.front().planes[plane].size(), 0.0F);
        for (const Sweep &sweep : sweeps)
            cv::accumulate(sweep.planes[plane], sum);
        sum /= static_cast<double>(sweeps.size());
        cv::GaussianBlur(sum, sum, {}, BoardView::smoothing);
        means.push_back(sum);
    }
    return means;
}

cv::Mat1f gradient_energy(const cv::Mat1f &picture)
{
    cv::Mat1f x, y;
    cv::Sobel(picture, x, CV_32F, 1, 0, 3, 1.0 / 8.0);
    cv::Sobel(picture, y, CV_32F, 0, 1, 3, 1.0 / 8.0);
    return x.mul(x) + y.mul(y);
}

/* Planes from the sharpest on. */
std::vector<std::size_t> by_sharpness(const std::vector<cv::Mat1f> &energies)
{
    std::vector<std::size_t> order(energies.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<double> sharpness;
    for (const cv::Mat1f &energy : energies)
        sharpness.push_back(energy.dot(energy));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sharpness[a] > sharpness[b]; });
    return order;
}

constexpr int exactly = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;

/* Whether there is a board or a part of one. */
bool has_any_board(const cv::Mat1b &picture)
{
    cv::Mat corners;
    const cv::Size least(Board::fewest_squares - 1, Board::fewest_squares - 1);
    return cv::findChessboardCornersSB(picture, least, corners, exactly | cv::CALIB_CB_LARGER);
}

[[noreturn]] void tell_why(const Board &board, bool is_any)
{
    const std::string size = std::to_string(board.columns) + "x" + std::to_string(board.rows);
    if (is_any)
        throw NoBoard(
            "a board is seen, but not all of one of " + size +
            " squares: it is cut off or covered (move it into the picture, with its white border), or it has "
            "another number of squares (count the dark and the white ones, and say so with --board)");
    throw NoBoard(
        "no board was found: show the whole board of " + size +
        " squares with its white border, flat, still, evenly lit, and within the range that the sweep "
        "sees sharp");
}

std::vector<cv::Point2f> find_corners(const Board &board, const cv::Mat1b &picture)
{
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCornersSB(picture, board.corners(), corners, exactly))
        corners.clear();
    return corners;
}

/* Half the window that holds a corner and no other. */
int window_of(const Board &board, const std::vector<cv::Point2f> &corners)
{
    double nearest = 1e9;
    const cv::Size size = board.corners();
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++) {
            const auto k = static_cast<std::size_t>(y * size.width + x);
            if (x > 0)
                nearest = std::min(nearest, cv::norm(corners[k] - corners[k - 1]));
            if (y > 0)
                nearest = std::min(nearest,
                                   cv::norm(corners[k] - corners[k - static_cast<std::size_t>(size.width)]));
        }
    return std::clamp(static_cast<int>(0.4 * nearest), 3, 24);
}

cv::Rect window_around(const cv::Point2f &corner, int window)
{
    return {cvRound(corner.x) - window, cvRound(corner.y) - window, 2 * window + 1, 2 * window + 1};
}

bool lies_inside(const cv::Rect &rectangle, const cv::Size &picture)
{
    return (rectangle & cv::Rect({}, picture)) == rectangle;
}

/* Refines corners from where a neighbouring plane has them. */
std::vector<SeenCorner> corners_in(const cv::Mat1f &picture, const cv::Mat1f &energy,
                                   const std::vector<cv::Point2f> &from, int window)
{
    std::vector<cv::Point2f> found = from;
    cv::cornerSubPix(picture, found, {window, window}, {-1, -1},
                     cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-3));
    std::vector<SeenCorner> corners(found.size());
    for (std::size_t k = 0; k < found.size(); k++) {
        const cv::Rect around = window_around(found[k], window);
        if (lies_inside(around, picture.size()) && cv::norm(found[k] - from[k]) < window / 2.0)
            corners[k] = {found[k], cv::mean(energy(around))[0]};
    }
    return corners;
}

std::vector<cv::Point2f> positions_of(const std::vector<SeenCorner> &corners,
                                      const std::vector<cv::Point2f> &otherwise)
{
    std::vector<cv::Point2f> positions = otherwise;
    for (std::size_t k = 0; k < corners.size(); k++)
        if (corners[k].energy > 0.0)
            positions[k] = corners[k].at;
    return positions;
}

std::vector<std::vector<cv::Point2d>> places_of(const std::vector<std::vector<SeenCorner>> &planes)
{
    std::vector<std::vector<cv::Point2d>> places;
    for (const auto &plane : planes) {
        places.emplace_back();
        for (const SeenCorner &corner : plane)
            places.back().push_back(corner.energy > 0.0 ? corner.at : cv::Point2d(NAN, NAN));
    }
    return places;
}

/* Where each corner is sharpest, by what it says alone; most must be so within the sweep. */
void require_sharpness(BoardView &view)
{
    const double blur_step = find_blur_step({view});
    std::size_t sharp = 0;
    for (std::size_t k = 0; k < view.corners.size(); k++) {
        std::vector<double> energies;
        for (const auto &plane : view.planes)
            energies.push_back(plane[k].energy);
        const auto curve = fit_curve(energies, view.window, blur_step);
        view.focus.push_back(curve ? curve->vertex : NAN);
        sharp += curve ? 1 : 0;
    }
    if (2 * sharp < view.corners.size())
        throw NoBoard("the board is blurred in every plane: bring it to where the sweep sees it sharp");
}

} // namespace

cv::Point2d BoardView::middle() const
{
    cv::Point2d sum;
    for (const cv::Point2d &corner : corners)
        sum += corner;
    return sum / static_cast<double>(corners.size());
}

double BoardView::moved_from(const BoardView &other) const
{
    double sum = 0.0;
    for (std::size_t k = 0; k < corners.size(); k++)
        sum += (corners[k] - other.corners[k]).ddot(corners[k] - other.corners[k]);
    return std::sqrt(sum / static_cast<double>(corners.size()));
}

BoardView measure_board(const Board &board, const std::vector<Sweep> &sweeps)
{
    const std::vector<cv::Mat1f> pictures = mean_planes(sweeps);
    std::vector<cv::Mat1f> energies;
    for (const cv::Mat1f &picture : pictures)
        energies.push_back(gradient_energy(picture));
    const std::vector<std::size_t> order = by_sharpness(energies);
    std::vector<cv::Point2f> corners;
    std::size_t first = 0;
    constexpr std::size_t tries = 3;
    for (std::size_t k = 0; k < std::min(tries, order.size()) && corners.empty(); k++) {
        first = order[k];
        cv::Mat1b picture;
        pictures[first].convertTo(picture, CV_8U);
        corners = find_corners(board, picture);
    }
    if (corners.empty()) {
        cv::Mat1b picture;
        pictures[order.front()].convertTo(picture, CV_8U);
        tell_why(board, has_any_board(picture));
    }

    const int window = window_of(board, corners);
    BoardView view{.picture = pictures.front().size(),
                   .planes = std::vector<std::vector<SeenCorner>>(pictures.size()),
                   .corners = {},
                   .focus = {},
                   .powers = sweeps.front().powers,
                   .codes = sweeps.front().codes,
                   .window = window};
    for (const int step : {1, -1}) {
        std::vector<cv::Point2f> from = corners;
        for (auto z = static_cast<int>(first); z >= 0 && z < static_cast<int>(pictures.size()); z += step) {
            const auto plane = static_cast<std::size_t>(z);
            view.planes[plane] = corners_in(pictures[plane], energies[plane], from, window);
            from = positions_of(view.planes[plane], from);
        }
    }
    for (std::size_t k = 0; k < corners.size(); k++) {
        const SeenCorner &corner = view.planes[first][k];
        if (corner.energy == 0.0 && !lies_inside(window_around(corners[k], window), view.picture))
            throw NoBoard("the board touches the border of the picture: move it in");
        if (corner.energy == 0.0) /* no corner is where one of such a board would be */
            tell_why(board, true);
        view.corners.push_back(corner.at);
    }
    require_sharpness(view);
    view.squares = measure_squares(board, sweeps, places_of(view.planes));
    return view;
}

} // namespace dff
