/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/warp_solver.h"

#include <algorithm>
#include <array>

namespace dff {
namespace {

/* Pixels that were matched: the least spread of a link's points around the common warp that is believed, a
 * step of Gauss-Newton each. The last is what points of equally sharp planes have; the wider ones before lead
 * there from a start that is not so close. The wider tail is points that wander with the blur of an edge. */
constexpr std::array least_spreads{1.0, 0.5, 0.25, 0.12, 0.07, 0.07};
constexpr double finest_spread = least_spreads.back();

/* Of a tie between neighbours at each corner: enough to decide where no point does, too little to be felt
 * elsewhere, even where a hand moved neighbours by a tenth of the picture and all links are of the smallest
 * size: there a point counts for some thousandths of what it may. */
constexpr double tie_weight = 1e-7;

/* A warp has up to eight numbers: similarities are [a -b c; b a d], homographies [a b c; d e f; g h 1]. */
constexpr int most_numbers = 8;
using Numbers = std::array<double, most_numbers>;

int numbers_of(MotionModel model)
{
    return model == MotionModel::Similarity ? 4 : 8;
}

/* Where a point goes, and the derivatives of that by the warp's numbers. */
struct Image {
    cv::Point2d point;
    Numbers by_x, by_y;
};

Image image_of(MotionModel model, const PlaneWarp &warp, cv::Point2d p)
{
    if (model == MotionModel::Similarity)
        return {warp.apply(p), {p.x, -p.y, 1.0, 0.0}, {p.y, p.x, 0.0, 1.0}};

    const cv::Matx33d &h = warp.matrix();
    const double w = 1.0 / (h(2, 0) * p.x + h(2, 1) * p.y + 1.0);
    const cv::Point2d q = warp.apply(p);
    return {q,
            {p.x * w, p.y * w, w, 0.0, 0.0, 0.0, -q.x * p.x * w, -q.x * p.y * w},
            {0.0, 0.0, 0.0, p.x * w, p.y * w, w, -q.y * p.x * w, -q.y * p.y * w}};
}

PlaneWarp moved(MotionModel model, const PlaneWarp &warp, const cv::Mat1d &step)
{
    cv::Matx33d h = warp.matrix();

    if (model == MotionModel::Similarity)
        return {h(0, 0) + step(0), h(1, 0) + step(1), h(0, 2) + step(2), h(1, 2) + step(3)};
    for (int i = 0; i < most_numbers; i++)
        h.val[i] += step(i);
    return PlaneWarp(h);
}

/* What the points of one link add to the normal equations: the Gram matrix of the rows
 * [derivatives of A_from p, -derivatives of A_to q, A_from p - A_to q], of which the upper half is kept. */
class LinkEquations {
public:
    explicit LinkEquations(int numbers) : numbers_(numbers) {}

    /* weight * |A_from p - A_to q|^2 */
    void add(const Image &from, const Image &to, double weight)
    {
        add_row(from.by_x, to.by_x, from.point.x - to.point.x, weight);
        add_row(from.by_y, to.by_y, from.point.y - to.point.y, weight);
    }

    double matrix(int row, int column) const { return gram_(std::min(row, column), std::max(row, column)); }
    double right(int row) const { return -gram_(row, 2 * numbers_); }

private:
    void add_row(const Numbers &from, const Numbers &to, double miss, double weight)
    {
        std::array<double, 2 * most_numbers + 1> row;
        for (int i = 0; i < numbers_; i++) {
            row[i] = from[i];
            row[numbers_ + i] = -to[i];
        }
        row[2 * numbers_] = miss;
        for (int r = 0; r < 2 * numbers_; r++) {
            for (int c = r; c <= 2 * numbers_; c++)
                gram_(r, c) += weight * row[r] * row[c];
        }
    }

    int numbers_;
    cv::Matx<double, 2 * most_numbers, 2 * most_numbers + 1> gram_;
};

/* One step of Gauss-Newton: the normal equations of the linearised problem. Lengths are in halves of the
 * picture's longer side, so that all numbers of a warp are of one size. */
class GaussNewtonStep {
public:
    GaussNewtonStep(MotionModel model, std::span<const PlaneWarp> warps)
        : model_(model), numbers_(numbers_of(model)), warps_(warps),
          matrix_(cv::Mat1d::zeros(columns(), columns())), right_(cv::Mat1d::zeros(columns(), 1))
    {
    }

    void add(std::size_t from, std::size_t to, const LinkEquations &link)
    {
        const auto place = [&](int i) {
            return i < numbers_ ? range(from).start + i : range(to).start + i - numbers_;
        };
        for (int r = 0; r < 2 * numbers_; r++) {
            for (int c = 0; c < 2 * numbers_; c++)
                matrix_(place(r), place(c)) += link.matrix(r, c);
            right_(place(r)) += link.right(r);
        }
    }

    /* Plane `fixed` stays as it is. */
    std::vector<PlaneWarp> solve(std::size_t fixed)
    {
        matrix_.rowRange(range(fixed)).setTo(0.0);
        matrix_.colRange(range(fixed)).setTo(0.0);
        matrix_(range(fixed), range(fixed)) = cv::Mat1d::eye(numbers_, numbers_);
        right_.rowRange(range(fixed)).setTo(0.0);

        cv::Mat1d step;
        cv::solve(matrix_, right_, step, cv::DECOMP_CHOLESKY);
        std::vector<PlaneWarp> result;
        for (std::size_t z = 0; z < warps_.size(); z++)
            result.push_back(moved(model_, warps_[z], step.rowRange(range(z))));
        return result;
    }

private:
    int columns() const { return numbers_ * static_cast<int>(warps_.size()); }

    cv::Range range(std::size_t plane) const
    {
        const int first = numbers_ * static_cast<int>(plane);
        return {first, first + numbers_};
    }

    MotionModel model_;
    int numbers_;
    std::span<const PlaneWarp> warps_;
    cv::Mat1d matrix_;
    cv::Mat1d right_;
};

/* `finest` is the smallest pixel that any link has. */
LinkEquations equations_of(MotionModel model, const PlaneLink &link, std::span<const PlaneWarp> warps,
                           double unit, double least_spread, double finest)
{
    std::vector<Image> from, to;
    std::vector<double> miss;
    for (std::size_t i = 0; i < link.match.from.size(); i++) {
        from.push_back(image_of(model, warps[link.from], link.match.from[i] / unit));
        to.push_back(image_of(model, warps[link.to], link.match.to[i] / unit));
        miss.push_back(cv::norm(from[i].point - to[i].point) * unit / link.pixel);
    }

    const double spread = std::max(least_spread, median(miss));
    const double link_weight = std::pow(finest_spread / spread * finest / link.pixel, 2.0);
    LinkEquations equations(numbers_of(model));
    for (std::size_t i = 0; i < miss.size(); i++)
        equations.add(from[i], to[i], link_weight / (1.0 + std::pow(miss[i] / spread, 2.0)));
    return equations;
}

void tie_neighbours(GaussNewtonStep &step, MotionModel model, std::span<const PlaneWarp> warps,
                    cv::Point2d corner)
{
    for (std::size_t z = 0; z + 1 < warps.size(); z++) {
        LinkEquations tie(numbers_of(model));
        for (const cv::Point2d point :
             {cv::Point2d{-corner.x, -corner.y}, {corner.x, -corner.y}, {-corner.x, corner.y}, corner})
            tie.add(image_of(model, warps[z], point), image_of(model, warps[z + 1], point), tie_weight);
        step.add(z, z + 1, tie);
    }
}

} // namespace

std::vector<PlaneWarp> solve_warps(MotionModel model, std::vector<PlaneWarp> warps, std::size_t reference,
                                   std::span<const PlaneLink> links, cv::Size size)
{
    const double unit = std::max(size.width, size.height) / 2.0;
    const cv::Point2d corner(size.width / 2.0 / unit, size.height / 2.0 / unit);
    const double finest = links.empty() ? 1.0 : std::ranges::min(links, {}, &PlaneLink::pixel).pixel;

    for (PlaneWarp &warp : warps)
        warp = warp.in_picture_larger_by(1.0 / unit, 1.0 / unit);
    for (const double least_spread : least_spreads) {
        GaussNewtonStep step(model, warps);
        for (const PlaneLink &link : links)
            step.add(link.from, link.to, equations_of(model, link, warps, unit, least_spread, finest));
        tie_neighbours(step, model, warps, corner);
        warps = step.solve(reference);
    }
    for (PlaneWarp &warp : warps)
        warp = warp.in_picture_larger_by(unit, unit);
    return warps;
}

std::vector<double> misses(const PlaneLink &link, std::span<const PlaneWarp> warps)
{
    std::vector<double> result;

    for (std::size_t i = 0; i < link.match.from.size(); i++) {
        const cv::Point2d from = warps[link.from].apply(link.match.from[i]);
        result.push_back(cv::norm(from - warps[link.to].apply(link.match.to[i])) / link.pixel);
    }
    return result;
}

double median(std::vector<double> values)
{
    if (values.empty())
        return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

} // namespace dff
