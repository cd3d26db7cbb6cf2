/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/brightness_evener.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <opencv2/imgproc.hpp>

#include "focalstack/plane_placing.h"

namespace dff {
namespace {

/* Of the longer side. */
constexpr int cells = 64;

/* Shares of what a pixel can hold: nearer than this to either end it may be clipped, */
constexpr double clipped = 0.015;
/* and points that lie this close to the line are not doubted. */
constexpr double least_spread = 0.001;

/* How much black counts, in cells, and how many cells are needed. */
constexpr double black_share = 0.1;
constexpr std::size_t min_cells = 24;

constexpr int rounds = 12;

/* More than this is no flicker. */
constexpr double max_gain = 4.0;

double largest_value(const cv::Mat &picture)
{
    return picture.depth() == CV_16U ? 65535.0 : 255.0;
}

/* The means of the cells of one plane, and which of them are whole: shown and not clipped. */
struct CellMeans {
    cv::Mat means;
    cv::Mat1b whole;
};

CellMeans means_of(const cv::Mat &plane, std::size_t colours, const PlaneAlignment &alignment, int step)
{
    const double factor = static_cast<double>(cells) / std::max(plane.cols, plane.rows);
    const double largest = largest_value(plane);
    CellMeans result;
    cv::Mat unclipped, shown;

    cv::resize(plane, result.means, {}, factor, factor, cv::INTER_AREA);
    result.means.convertTo(result.means, CV_32F);

    cv::Scalar low = cv::Scalar::all(0.0),
               high = cv::Scalar::all(largest); /* a fourth channel is no colour */
    for (int i = 0; i < static_cast<int>(colours); i++) {
        low[i] = clipped * largest;
        high[i] = (1.0 - clipped) * largest;
    }
    cv::inRange(plane, low, high, unclipped);
    cv::resize(unclipped, unclipped, result.means.size(), 0.0, 0.0, cv::INTER_AREA);
    const PlaneWarp warp =
        alignment.warp.in_picture_larger_by(static_cast<double>(result.means.cols) / (plane.cols * step),
                                            static_cast<double>(result.means.rows) / (plane.rows * step));
    cv::warpPerspective(cv::Mat1b(result.means.size(), 255), shown, warp.pixel_matrix(result.means.size()),
                        result.means.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
    result.whole = (unclipped > 250) & (shown > 250);
    return result;
}

using Points = std::vector<cv::Point2d>;

/* What one channel of two planes shows in the cells that are whole in both. */
Points common_points(const CellMeans &from, const CellMeans &to, int channel)
{
    std::vector<cv::Mat> from_channels, to_channels;
    cv::split(from.means, from_channels);
    cv::split(to.means, to_channels);
    const cv::Mat1f a = from_channels[static_cast<std::size_t>(channel)];
    const cv::Mat1f b = to_channels[static_cast<std::size_t>(channel)];
    Points points;

    for (int y = 0; y < a.rows; y++) {
        for (int x = 0; x < a.cols; x++) {
            if (from.whole(y, x) && to.whole(y, x))
                points.emplace_back(a(y, x), b(y, x));
        }
    }
    return points;
}

struct Line {
    cv::Point2d centre, direction{std::sqrt(0.5), std::sqrt(0.5)};

    double distance(cv::Point2d point) const { return std::abs((point - centre).cross(direction)); }
};

/* The principal axis of the weighted points. */
Line fit_line(const Points &points, const std::vector<double> &weights)
{
    double sum = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    Line line;

    for (std::size_t i = 0; i < points.size(); i++) {
        sum += weights[i];
        line.centre += weights[i] * points[i];
    }
    line.centre /= sum;
    for (std::size_t i = 0; i < points.size(); i++) {
        const cv::Point2d p = points[i] - line.centre;
        xx += weights[i] * p.x * p.x;
        xy += weights[i] * p.x * p.y;
        yy += weights[i] * p.y * p.y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    line.direction = {std::cos(angle), std::sin(angle)};
    return line;
}

/* What brings x onto y, by iteratively reweighted total least squares with Cauchy's weights. */
Brightness fit_brightness(Points points, double black, double largest)
{
    if (points.size() < min_cells)
        return {};

    std::vector<double> weights(points.size(), 1.0);
    std::vector<double> shares = weights;
    points.emplace_back(black, black);
    shares.push_back(black_share * static_cast<double>(weights.size()));
    weights = shares;

    Line line;
    for (int i = 0; i < rounds; i++) {
        line = fit_line(points, weights);
        std::vector<double> distances;
        for (const cv::Point2d point : points)
            distances.push_back(line.distance(point));
        const double spread = std::max(least_spread * largest, median(distances));
        for (std::size_t k = 0; k < points.size(); k++)
            weights[k] = shares[k] / (1.0 + std::pow(distances[k] / spread, 2.0));
    }
    const double gain = line.direction.y / line.direction.x;
    if (!(gain > 1.0 / max_gain && gain < max_gain))
        return {};
    return {gain, line.centre.y - gain * line.centre.x};
}

/* First `inner`, then `outer`. */
Brightness chained(const Brightness &outer, const Brightness &inner)
{
    return {outer.gain * inner.gain, outer.apply(inner.offset)};
}

Brightness inverse(const Brightness &brightness)
{
    return {1.0 / brightness.gain, -brightness.offset / brightness.gain};
}

/* One channel of all planes onto the middle plane. */
std::vector<Brightness> onto_middle(std::span<const CellMeans> planes, std::span<const bool> usable,
                                    int channel, double black, double largest)
{
    const std::size_t middle = middle_plane(planes.size());
    std::vector<Brightness> result(planes.size());
    const auto follow = [&](std::size_t first, std::size_t end, std::size_t step) {
        std::size_t last = middle;
        for (std::size_t z = first; z != end; z += step) {
            if (!usable[z])
                continue;
            result[z] = chained(result[last], fit_brightness(common_points(planes[z], planes[last], channel),
                                                             black, largest));
            last = z;
        }
    };

    follow(middle + 1, planes.size(), 1);
    follow(middle - 1, static_cast<std::size_t>(-1), static_cast<std::size_t>(-1));
    return result;
}

void set_brightness(cv::Mat picture, std::span<const Brightness> channels)
{
    const double largest = largest_value(picture);
    const bool needed = std::ranges::any_of(channels, [&](const Brightness &brightness) {
        return std::max(std::abs(brightness.offset), std::abs(brightness.apply(largest) - largest)) >
               largest / 510.0;
    });
    if (!needed)
        return;

    cv::Mat1f matrix = cv::Mat1f::eye(picture.channels(), picture.channels() + 1);
    for (int i = 0; i < static_cast<int>(channels.size()); i++) {
        matrix(i, i) = static_cast<float>(channels[static_cast<std::size_t>(i)].gain);
        matrix(i, picture.channels()) = static_cast<float>(channels[static_cast<std::size_t>(i)].offset);
    }
    cv::transform(picture, picture, matrix);
}

} // namespace

std::vector<std::vector<Brightness>> find_brightness(std::span<const cv::Mat> aligned,
                                                     std::span<const PlaneAlignment> alignments,
                                                     std::span<const double> black, int step)
{
    const double largest = largest_value(aligned.front());
    std::vector<CellMeans> means;
    std::vector<std::vector<Brightness>> result(aligned.size());
    const auto usable = std::make_unique<bool[]>(aligned.size());

    for (std::size_t z = 0; z < aligned.size(); z++) {
        means.push_back(means_of(aligned[z], black.size(), alignments[z], step));
        usable[z] = is_shown(alignments[z]);
    }
    for (std::size_t channel = 0; channel < black.size(); channel++) {
        const std::vector<Brightness> onto = onto_middle(means, {usable.get(), aligned.size()},
                                                         static_cast<int>(channel), black[channel], largest);
        std::vector<double> gains(onto.size());
        std::ranges::transform(onto, gains.begin(), &Brightness::gain);
        const auto reference = std::ranges::find(gains, median(gains)) - gains.begin();
        for (std::size_t z = 0; z < aligned.size(); z++)
            result[z].push_back(chained(inverse(onto[static_cast<std::size_t>(reference)]), onto[z]));
    }
    return result;
}

void even_brightness(std::span<const cv::Mat> aligned, std::span<const PlaneAlignment> alignments,
                     std::span<const double> black, int step)
{
    const std::vector<std::vector<Brightness>> brightness = find_brightness(aligned, alignments, black, step);

    for (std::size_t z = 0; z < aligned.size(); z++)
        set_brightness(aligned[z], brightness[z]);
}

} // namespace dff
