/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "board_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

constexpr double inner = 0.2; /* of a square's side: half the side of what is looked at */
/* DN; beyond them noise and light are cut off. */
constexpr double darkest = 8.0, brightest = 245.0;

/* A square's corners, clockwise from the upper left one. */
using Square = std::array<cv::Point2d, 4>;

/* NAN if a corner was not seen. */
double shortest_side(const Square &square)
{
    double side = INFINITY;
    for (std::size_t i = 0; i < square.size(); i++) {
        const double next = cv::norm(square[i] - square[(i + 1) % square.size()]);
        if (std::isnan(next))
            return NAN;
        side = std::min(side, next);
    }
    return side;
}

cv::Rect inside(const Square &square, double side)
{
    const cv::Point2d middle = (square[0] + square[1] + square[2] + square[3]) / 4.0;
    const int half = static_cast<int>(inner * side);
    return {cvRound(middle.x) - half, cvRound(middle.y) - half, 2 * half + 1, 2 * half + 1};
}

/* Immerkaer 1996: [1 -2 1] x [1 -2 1] sees neither level nor slope, and noise 36-fold. */
double noise_variance(const cv::Mat1f &patch)
{
    const cv::Mat1f kernel = (cv::Mat1f(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
    cv::Mat1f response;
    cv::filter2D(patch, response, CV_32F, kernel, {-1, -1}, 0.0, cv::BORDER_REPLICATE);
    const cv::Mat1f whole = response(cv::Rect(1, 1, patch.cols - 2, patch.rows - 2));
    return whole.dot(whole) / 36.0 / static_cast<double>(whole.total());
}

double noise_of(const std::vector<Sweep> &sweeps, std::size_t plane, const cv::Rect &where)
{
    double sum = 0.0;
    if (sweeps.size() == 1)
        return noise_variance(cv::Mat1f(sweeps.front().planes[plane](where)));
    for (std::size_t k = 1; k < sweeps.size(); k++) {
        const cv::Mat1f after = sweeps[k].planes[plane](where), before = sweeps[k - 1].planes[plane](where);
        sum += noise_variance(after - before) / 2.0;
    }
    return sum / static_cast<double>(sweeps.size() - 1);
}

double mean_of(const std::vector<Sweep> &sweeps, std::size_t plane, const cv::Rect &where)
{
    double sum = 0.0;
    for (const Sweep &sweep : sweeps)
        sum += cv::mean(sweep.planes[plane](where))[0];
    return sum / static_cast<double>(sweeps.size());
}

/* Squares take turns: which turn the white ones have. */
void tell_colours(std::vector<SquareLight> &squares, int columns)
{
    std::array<double, 2> sum{}, count{};
    const auto turn = [columns](const SquareLight &square) {
        const auto k = static_cast<int>(square.corner);
        return static_cast<std::size_t>((k % columns + k / columns) % 2);
    };
    for (const SquareLight &square : squares) {
        sum[turn(square)] += square.value;
        count[turn(square)] += 1.0;
    }
    const std::size_t white = sum[1] * count[0] > sum[0] * count[1] ? 1 : 0;
    for (SquareLight &square : squares)
        square.is_white = turn(square) == white;
}

/* Whether the blur of the square's edges ends before what is looked at, however the square is turned. */
bool is_clear(const SquareLight &square, const BoardSquares &view, double blur_step)
{
    constexpr double smoothing_px = 1.5;
    const double focus = view.focus[square.corner];
    const double radius = blur_step * std::abs(static_cast<double>(square.plane) - focus) / 2.0;
    return radius + smoothing_px < (0.5 - inner * std::numbers::sqrt2) * square.side;
}

struct Place {
    double square_of_radius;
    cv::Point2d on_board; /* from its middle, in halves of it */
};

Place place_of(const SquareLight &square, const Board &board, cv::Size picture)
{
    const cv::Point2d center((picture.width - 1) / 2.0, (picture.height - 1) / 2.0);
    const cv::Point2d at = (square.at - center) / cv::norm(center);
    const cv::Size corners = board.corners();
    const auto k = static_cast<int>(square.corner);
    const cv::Point2d half((corners.width - 1) / 2.0, (corners.height - 1) / 2.0);
    return {at.ddot(at),
            {(k % corners.width + 0.5 - half.x) / half.x, (k / corners.width + 0.5 - half.y) / half.y}};
}

/* An equation of the fit: the logarithm of a square's brightness. */
struct Reading {
    std::size_t view, plane;
    Place place;
    double log_value;
};

struct Readings {
    std::vector<Reading> all;
    bool is_clipped = false;
};

Readings readings_of(const Board &board, const std::vector<BoardSquares> &views, cv::Size picture,
                     double blur_step)
{
    Readings readings;
    std::size_t clipped = 0;
    for (std::size_t v = 0; v < views.size(); v++)
        for (const SquareLight &square : views[v].squares) {
            if (!square.is_white || !is_clear(square, views[v], blur_step))
                continue;
            if (square.value > brightest)
                clipped++;
            else if (square.value > darkest)
                readings.all.push_back(
                    {v, square.plane, place_of(square, board, picture), std::log(square.value)});
        }
    readings.is_clipped = clipped > readings.all.size() / 10;
    return readings;
}

bool are_enough(const std::vector<Reading> &readings, std::size_t planes)
{
    constexpr std::size_t fewest = 12;
    std::vector<std::size_t> counts(planes);
    for (const Reading &reading : readings)
        counts[reading.plane]++;
    return *std::min_element(counts.begin(), counts.end()) >= fewest;
}

/* Least squares for the logarithm of a square's brightness: log(light of the view) + lean + log(gain of the
 * plane) + log(1 - vignetting r^2), of which the last is not linear: a few rounds. */
class LightFit {
public:
    LightFit(std::size_t views, std::size_t planes)
        : views_(views), planes_(planes), solution_(cv::Mat1d::zeros(of_plane(planes), 1))
    {
    }

    int unknowns() const { return solution_.rows; }
    void go_on(const std::vector<Reading> &readings);

    double gain(std::size_t plane) const { return std::exp(solution_(of_plane(plane))); }
    double vignetting(std::size_t plane) const { return solution_(of_plane(plane) + 1); }
    /* Root mean square of what was left before the last round, in parts of the light. */
    double residual() const { return residual_; }
    /* One standard deviation, if each reading erred by itself. */
    double vignetting_deviation(std::size_t plane) const
    {
        const int k = of_plane(plane) + 1;
        return std::max(residual_, precise) * std::sqrt(inverse_(k, k));
    }

private:
    static constexpr double precise = 5e-3; /* parts: what paper and light leave at best */

    /* Of each view the logarithm of its light and how that leans to the right and down, of each plane the
     * logarithm of its gain and its vignetting. */
    static int of_view(std::size_t view) { return static_cast<int>(3 * view); }
    int of_plane(std::size_t plane) const { return static_cast<int>(3 * views_ + 2 * plane); }

    void add(const Reading &reading);
    void hold(int unknown, double spread);

    std::size_t views_, planes_;
    cv::Mat1d solution_, inverse_, normal_, right_;
    double sum_ = 0.0, residual_ = 0.0;
};

void LightFit::add(const Reading &reading)
{
    const auto &[square, on_board] = reading.place;
    const int view = of_view(reading.view), plane = of_plane(reading.plane);
    const double kept = 1.0 - solution_(plane + 1) * square;
    const std::array<std::pair<int, double>, 5> row{{{view, 1.0},
                                                     {view + 1, on_board.x},
                                                     {view + 2, on_board.y},
                                                     {plane, 1.0},
                                                     {plane + 1, -square / kept}}};
    const double left = reading.log_value - solution_(view) - solution_(view + 1) * on_board.x -
                        solution_(view + 2) * on_board.y - solution_(plane) - std::log(kept);
    sum_ += left * left;
    for (const auto &[i, a] : row) {
        right_(i) += a * left;
        for (const auto &[j, b] : row)
            normal_(i, j) += a * b;
    }
}

/* What no reading tells lies around 0. */
void LightFit::hold(int unknown, double spread)
{
    const double weight = std::pow(precise / spread, 2.0);
    normal_(unknown, unknown) += weight;
    right_(unknown) -= weight * solution_(unknown);
}

void LightFit::go_on(const std::vector<Reading> &readings)
{
    constexpr double uneven = 0.03; /* how far a board's light leans from its middle to its side */
    constexpr double usual_gain = 1.0, usual_vignetting = 0.2;
    constexpr double fixed = 1e-6;
    normal_ = cv::Mat1d::zeros(unknowns(), unknowns());
    right_ = cv::Mat1d::zeros(unknowns(), 1);
    sum_ = 0.0;
    for (const Reading &reading : readings)
        add(reading);
    residual_ = std::sqrt(sum_ / static_cast<double>(readings.size()));
    for (std::size_t v = 0; v < views_; v++)
        for (const int lean : {1, 2})
            hold(of_view(v) + lean, uneven);
    for (std::size_t z = 0; z < planes_; z++) {
        hold(of_plane(z), z == planes_ / 2 ? fixed : usual_gain);
        hold(of_plane(z) + 1, usual_vignetting);
    }
    inverse_ = normal_.inv(cv::DECOMP_SVD);
    solution_ += inverse_ * right_;
    for (std::size_t z = 0; z < planes_; z++)
        solution_(of_plane(z) + 1) = std::clamp(solution_(of_plane(z) + 1), -0.5, 0.9);
}

} // namespace

std::vector<SquareLight> measure_squares(const Board &board, const std::vector<Sweep> &sweeps,
                                         const std::vector<std::vector<cv::Point2d>> &corners)
{
    constexpr double least_side = 10.0; /* pixels: below, edges reach in */
    std::vector<SquareLight> squares;
    const int columns = board.corners().width, rows = board.corners().height;
    for (std::size_t plane = 0; plane < corners.size(); plane++) {
        const cv::Rect picture({}, sweeps.front().planes[plane].size());
        for (int y = 0; y + 1 < rows; y++)
            for (int x = 0; x + 1 < columns; x++) {
                const auto k = static_cast<std::size_t>(y * columns + x),
                           width = static_cast<std::size_t>(columns);
                const auto &all = corners[plane];
                const Square square{all[k], all[k + 1], all[k + width + 1], all[k + width]};
                const double side = shortest_side(square);
                if (!(side >= least_side)) /* NAN, too */
                    continue;
                const cv::Rect where = inside(square, side);
                if ((where & picture) != where)
                    continue;
                squares.push_back({.plane = plane,
                                   .corner = k,
                                   .at = (square[0] + square[2]) / 2.0,
                                   .side = side,
                                   .value = mean_of(sweeps, plane, where),
                                   .variance = noise_of(sweeps, plane, where)});
            }
    }
    tell_colours(squares, columns);
    return squares;
}

RigLight fit_light(const Board &board, const std::vector<BoardSquares> &views, cv::Size picture,
                   std::size_t planes, double blur_step)
{
    constexpr int rounds = 5;
    constexpr double independent = 6.0; /* squares of a board err together; so many do not */
    const auto [readings, is_clipped] = readings_of(board, views, picture, blur_step);
    LightFit fit(views.size(), planes);
    RigLight light;
    light.is_clipped = is_clipped;
    if (is_clipped || !are_enough(readings, planes))
        return light;
    for (int round = 0; round < rounds; round++)
        fit.go_on(readings);
    light.residual = fit.residual();
    const double alike = std::max(1.0, static_cast<double>(readings.size()) /
                                           (independent * static_cast<double>(views.size())));
    for (std::size_t z = 0; z < planes; z++)
        light.planes.push_back(
            {fit.gain(z), fit.vignetting(z), std::sqrt(alike) * fit.vignetting_deviation(z)});
    return light;
}

RigNoise fit_noise(const std::vector<BoardSquares> &views, double blur_step)
{
    constexpr int rounds = 4;
    constexpr double range = 20.0; /* DN that brightness must span */
    constexpr std::size_t fewest = 20;
    std::vector<const SquareLight *> seen;
    double least = INFINITY, most = 0.0;
    for (const BoardSquares &view : views)
        for (const SquareLight &square : view.squares)
            if (is_clear(square, view, blur_step) && square.value > darkest && square.value <= brightest) {
                seen.push_back(&square);
                least = std::min(least, square.value);
                most = std::max(most, square.value);
            }
    RigNoise noise;
    if (seen.size() < fewest || most - least < range)
        return noise;
    noise.offset = 1.0;
    for (int round = 0; round < rounds; round++) {
        double ww = 0.0, wi = 0.0, wii = 0.0, wv = 0.0, wiv = 0.0;
        for (const SquareLight *square : seen) {
            /* An estimate of a variance errs in proportion to it. */
            const double expected = noise.slope * square->value + noise.offset;
            const double weight = square->side * square->side / (expected * expected);
            ww += weight;
            wi += weight * square->value;
            wii += weight * square->value * square->value;
            wv += weight * square->variance;
            wiv += weight * square->value * square->variance;
        }
        noise.slope = std::max((ww * wiv - wi * wv) / (ww * wii - wi * wi), 0.0);
        noise.offset = std::max((wv - noise.slope * wi) / ww, 1.0 / 12.0); /* of rounding */
    }
    noise.is_known = true;
    return noise;
}

} // namespace dff
