/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/object_rims.h"

#include "focalstack/in_parallel.h"
#include "focalstack/velocity_refinement.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

/* In pixels of the small pictures, and in brightnesses of which white has 256. */
constexpr int outer = 16, inner = 12; /* distances from the outline at which the share is looked for */
constexpr int distances = outer + inner + 1;
constexpr float at_outline = 0.5F;      /* share */
constexpr size_t most_shift = 4;        /* of an outline */
constexpr float own = 2.0F;             /* from the outline on, colours are the object's own, */
constexpr double spread = 4.0;          /* which are spread so far */
constexpr float no_share = 0.04F;       /* is noise */
constexpr float least_contrast = 30.0F; /* squared */
constexpr float texture_from = 4.0F;    /* from the outline on, texture is looked for */
constexpr double plain_below = 2.0, texture_above = 4.0; /* standard deviation of brightness */
constexpr float narrow = 2.0F;                           /* distances over which a sharp rim's share falls */
constexpr double little_noise = 1.0;                     /* variance */
constexpr int steps = 2;                                 /* of refine_plain_velocity() */
constexpr float rim = 8.0F;               /* around the outline, that tells a plain object's velocity */
constexpr float clear_contrast = 1000.0F; /* squared: with less the outline is believed by half */
constexpr float most_step = 0.5F;         /* pixels a plane */

/* The planes and what stands behind, moved to where objects are in the middle of the sweep: [z][channel]. */
struct MovedPlanes {
    std::vector<std::vector<cv::Mat1f>> pictures, behind;
    std::vector<cv::Mat1f> means; /* of all planes' pictures, a channel each */
};

/* Objects apart, and how deep in one each pixel lies; less than 0 outside. */
struct Outlines {
    cv::Mat1i object; /* the nearest, from 1 on */
    cv::Mat1f depth;
    int objects = 0;

    size_t bin(int y, int x) const
    {
        return static_cast<size_t>(std::clamp(cvRound(depth(y, x)), -outer, inner) + outer);
    }
};

MovedPlanes move_planes(const SmallStack &sweep, const StillBackground &background, const cv::Rect &where,
                        const cv::Mat2f &velocity)
{
    const unsigned planes = sweep.planes(), channels = sweep.channels();
    MovedPlanes moved;
    moved.pictures.resize(planes);
    moved.behind.resize(planes);
    in_parallel(planes, [&](unsigned z) {
        cv::Mat2f path;
        path_through(velocity, z - (planes - 1) / 2.0, path);
        for (unsigned c = 0; c < channels; c++) {
            cv::Mat1f picture, behind;
            cv::remap(sweep.picture(z, c)(where), picture, path, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
            cv::remap(background.plane(z, c)(where), behind, path, {}, cv::INTER_LINEAR,
                      cv::BORDER_REPLICATE);
            moved.pictures[z].push_back(picture);
            moved.behind[z].push_back(behind);
        }
    });
    for (unsigned c = 0; c < channels; c++) {
        cv::Mat1f mean = cv::Mat1f::zeros(where.size());
        for (unsigned z = 0; z < planes; z++)
            mean += moved.pictures[z][c] / static_cast<double>(planes);
        moved.means.push_back(mean);
    }
    return moved;
}

Outlines outlines_of(const cv::Mat1b &inside)
{
    Outlines outlines;
    cv::Mat1f outside;
    in_parallel(2, [&](unsigned i) {
        if (i == 0)
            cv::distanceTransform(inside, outlines.depth, cv::DIST_L2, cv::DIST_MASK_5);
        else
            cv::distanceTransform(inside == 0, outside, outlines.object, cv::DIST_L2, cv::DIST_MASK_5,
                                  cv::DIST_LABEL_CCOMP);
    });
    for (int y = 0; y < inside.rows; y++)
        for (int x = 0; x < inside.cols; x++) {
            float &depth = outlines.depth(y, x);
            depth = depth > 0.0F ? depth - 0.5F : 0.5F - outside(y, x);
            outlines.objects = std::max(outlines.objects, outlines.object(y, x));
        }
    return outlines;
}

/* Means of what lies well inside the objects, spread around. */
std::vector<cv::Mat1f> own_colours(const MovedPlanes &moved, const Outlines &outlines)
{
    cv::Mat1f weight;
    cv::Mat1b(outlines.depth > own).convertTo(weight, CV_32F, 1.0 / 255.0);
    const auto spread_out = [](const cv::Mat1f &of) {
        cv::Mat near, far;
        soften(of, spread, near);
        soften(of, 4.0 * spread, far);
        return cv::Mat1f(near + 0.01 * far);
    };
    const size_t channels = moved.means.size();
    cv::Mat1f weights;
    std::vector<cv::Mat1f> colours(channels);
    in_parallel(channels + 1, [&](unsigned i) {
        if (i < channels)
            colours[i] = spread_out(moved.means[i].mul(weight));
        else
            weights = cv::Mat1f(spread_out(weight) + 1e-6);
    });
    for (cv::Mat1f &colour : colours)
        colour /= weights;
    return colours;
}

/* How far, at one pixel, plane z lies on the way from what is behind to the object's colours: the two sums of
 * least squares. */
cv::Vec2f on_the_way(const MovedPlanes &moved, const std::vector<cv::Mat1f> &colours, unsigned z, int y,
                     int x)
{
    cv::Vec2f sums;
    for (size_t c = 0; c < colours.size(); c++) {
        const float behind = moved.behind[z][c](y, x), whole = colours[c](y, x) - behind;
        sums += cv::Vec2f((moved.pictures[z][c](y, x) - behind) * whole, whole * whole);
    }
    return sums;
}

/* From the sums at each distance, the outermost first, to shares that never fall inwards. */
std::array<float, distances> shares_of(const std::array<cv::Vec2f, distances> &sums)
{
    std::array<float, distances> shares;
    float least = 0.0F;
    for (size_t i = 0; i < distances; i++) {
        const bool is_known = sums[i][1] > least_contrast;
        const float step = i > outer ? 1.0F : 0.0F;
        const float found = is_known ? std::clamp(sums[i][0] / sums[i][1], 0.0F, 1.0F) : step;
        least = std::max(least, i + 1 == distances ? 1.0F : found);
        shares[i] = i == 0 || least < no_share ? 0.0F : least;
    }
    return shares;
}

/* Between two distances. */
float share_at(const std::array<float, distances> &shares, float depth)
{
    const float place = std::clamp(depth + outer, 0.0F, static_cast<float>(distances - 1));
    const auto below = std::min(static_cast<size_t>(place), size_t{distances - 2});
    return std::lerp(shares[below], shares[below + 1], place - static_cast<float>(below));
}

struct Surface {
    float plain = 0.0F;
    float noisy = 0.0F;
};

/* Of each object, from how much its brightness differs from that around, less what noise makes of it. */
std::vector<Surface> surfaces_of(const MovedPlanes &moved, const Outlines &outlines,
                                 const StillBackground::Noise &noise)
{
    cv::Mat1f smooth;
    const cv::Mat1f &brightness = moved.means.front();
    cv::blur(brightness, smooth, {7, 7});
    struct Sums {
        double squares = 0.0, noise = 0.0, pixels = 0.0;
    };
    std::vector<Sums> sums(static_cast<size_t>(outlines.objects) + 1);
    for (int y = 0; y < smooth.rows; y++)
        for (int x = 0; x < smooth.cols; x++)
            if (outlines.depth(y, x) > texture_from) {
                const auto difference = static_cast<double>(brightness(y, x) - smooth(y, x));
                const auto of_noise = static_cast<double>(
                    noise[0][static_cast<size_t>(std::clamp(smooth(y, x), 0.0F, 255.0F))]);
                Sums &sum = sums[static_cast<size_t>(outlines.object(y, x))];
                sum.squares += difference * difference;
                sum.noise += of_noise * of_noise;
                sum.pixels += 1.0;
            }
    std::vector<Surface> surfaces;
    for (const Sums &sum : sums) {
        Surface surface;
        if (sum.pixels > 0.0) {
            const double variance = sum.noise / sum.pixels;
            const double deviation = std::sqrt(std::max(
                sum.squares / sum.pixels - variance / static_cast<double>(moved.pictures.size()), 0.0));
            const double texture = (deviation - plain_below) / (texture_above - plain_below);
            surface.plain = static_cast<float>(1.0 - std::clamp(texture, 0.0, 1.0));
            surface.noisy = surface.plain * static_cast<float>(variance / (variance + little_noise));
        }
        surfaces.push_back(surface);
    }
    return surfaces;
}

/* How far a rim is as its share says: one that is narrow is narrower than these pixels show. */
float width_told(const std::array<float, distances> &shares)
{
    const auto within =
        std::ranges::count_if(shares, [](float share) { return share > 0.05F && share < 0.95F; });
    return std::clamp((static_cast<float>(within) - narrow) / narrow, 0.0F, 1.0F);
}

/* Fills in what is found of one plane; gives the share of each object at each distance. */
std::vector<std::array<float, distances>> find_in_plane(const MovedPlanes &moved, const Outlines &outlines,
                                                        const std::vector<Surface> &surfaces, unsigned z,
                                                        ObjectRims &rims)
{
    const cv::Size size = outlines.depth.size();
    std::vector<std::array<cv::Vec2f, distances>> sums(static_cast<size_t>(outlines.objects) + 1);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
            if (outlines.depth(y, x) > -outer && outlines.depth(y, x) < inner)
                sums[static_cast<size_t>(outlines.object(y, x))][outlines.bin(y, x)] +=
                    on_the_way(moved, rims.colours, z, y, x);
    std::vector<std::array<float, distances>> shares;
    std::vector<float> widths;
    for (const auto &of_object : sums) {
        shares.push_back(shares_of(of_object));
        widths.push_back(width_told(shares.back()));
    }
    cv::Mat1f share(size), noisy(size);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++) {
            const auto object = static_cast<size_t>(outlines.object(y, x));
            const float steeper = std::lerp(3.0F, 1.0F, std::max(widths[object], surfaces[object].plain));
            share(y, x) = std::clamp(steeper * (share_at(shares[object], outlines.depth(y, x)) - 0.5F) + 0.5F,
                                     0.0F, 1.0F);
            const float whole = std::clamp(10.0F * share(y, x) - 9.0F, 0.0F, 1.0F);
            noisy(y, x) = surfaces[object].noisy * std::max(whole, widths[object]);
        }
    rims.share[z] = share;
    rims.noisy[z] = noisy;
    return shares;
}

/* The depth at which half of the light is an object's, in the mean of all planes: its outline. */
float outline_depth(const std::vector<std::vector<std::array<float, distances>>> &shares, size_t object)
{
    std::array<float, distances> means{};
    for (const auto &of_plane : shares)
        for (size_t i = 0; i < distances; i++)
            means[i] += of_plane[object][i] / static_cast<float>(shares.size());
    for (size_t i = outer - most_shift; i < outer + most_shift; i++)
        if (means[i] <= at_outline && means[i + 1] > at_outline)
            return static_cast<float>(i) - outer + (at_outline - means[i]) / (means[i + 1] - means[i]);
    return 0.0F;
}

/* Outlines of objects where their light says; they are a pixel soft. */
void move_outlines(const std::vector<std::vector<std::array<float, distances>>> &shares,
                   const Outlines &outlines, const std::vector<Surface> &surfaces, cv::Mat1f &objects)
{
    std::vector<float> at;
    for (size_t object = 0; object < surfaces.size(); object++)
        at.push_back(outline_depth(shares, object));
    for (int y = 0; y < objects.rows; y++)
        for (int x = 0; x < objects.cols; x++) {
            const auto object = static_cast<size_t>(outlines.object(y, x));
            objects(y, x) =
                std::lerp(outlines.depth(y, x) - at[object] + 0.5F, objects(y, x), surfaces[object].plain);
        }
}

/* Each plane's share, pixel by pixel, and how clear they are in all planes. */
struct PixelShares {
    std::vector<cv::Mat1f> of_planes;
    cv::Mat1f clear;
};

PixelShares pixel_shares(const MovedPlanes &moved, const std::vector<cv::Mat1f> &colours)
{
    PixelShares shares;
    shares.clear = cv::Mat1f(colours.front().size(), 1.0F);
    for (unsigned z = 0; z < moved.pictures.size(); z++) {
        cv::Mat1f share(colours.front().size());
        for (int y = 0; y < share.rows; y++)
            for (int x = 0; x < share.cols; x++) {
                const cv::Vec2f sums = on_the_way(moved, colours, z, y, x);
                share(y, x) = std::clamp(sums[0] / (sums[1] + least_contrast), 0.0F, 1.0F);
                shares.clear(y, x) = std::min(shares.clear(y, x), sums[1] / (sums[1] + clear_contrast));
            }
        shares.of_planes.push_back(share);
    }
    return shares;
}

} // namespace

ObjectRims find_rims(const SmallStack &sweep, const StillBackground &background, const cv::Rect &where,
                     const cv::Mat1b &inside, const cv::Mat2f &velocity, const StillBackground::Noise &noise,
                     cv::Mat1f &objects)
{
    const MovedPlanes moved = move_planes(sweep, background, where, velocity);
    const Outlines outlines = outlines_of(inside);
    ObjectRims rims;
    rims.colours = own_colours(moved, outlines);
    rims.share.resize(sweep.planes());
    rims.noisy.resize(sweep.planes());
    const std::vector<Surface> surfaces = surfaces_of(moved, outlines, noise);
    std::vector<std::vector<std::array<float, distances>>> shares(sweep.planes());
    in_parallel(sweep.planes(),
                [&](unsigned z) { shares[z] = find_in_plane(moved, outlines, surfaces, z, rims); });
    move_outlines(shares, outlines, surfaces, objects);
    rims.plain.create(where.size());
    for (int y = 0; y < where.height; y++)
        for (int x = 0; x < where.width; x++)
            rims.plain(y, x) = surfaces[static_cast<size_t>(outlines.object(y, x))].plain;
    return rims;
}

void refine_plain_velocity(const SmallStack &sweep, const StillBackground &background, const cv::Rect &where,
                           const cv::Mat1b &inside, const StillBackground::Noise &noise, cv::Mat2f &velocity)
{
    const Outlines outlines = outlines_of(inside);
    for (int i = 0; i < steps; i++) {
        const MovedPlanes moved = move_planes(sweep, background, where, velocity);
        const std::vector<Surface> surfaces = surfaces_of(moved, outlines, noise);
        const PixelShares shares = pixel_shares(moved, own_colours(moved, outlines));
        for (int object = 1; object <= outlines.objects; object++) {
            if (surfaces[static_cast<size_t>(object)].plain <= 0.5F)
                continue;
            const cv::Mat1b of_object = outlines.object == object;
            cv::Mat1f weight = cv::Mat1f::zeros(where.size());
            shares.clear.copyTo(weight, of_object & (cv::abs(outlines.depth) < rim));
            const cv::Vec2f step = velocity_error(shares.of_planes, weight, most_step);
            /* What its parts seem to do differently was seen in noise. */
            velocity.setTo(cv::mean(velocity, of_object & (inside != 0)) + cv::Scalar(step[0], step[1]),
                           of_object);
        }
    }
}

void refine_plain_outline(const SmallStack &sweep, const StillBackground &background, const cv::Rect &where,
                          const cv::Mat1b &inside, const StillBackground::Noise &noise,
                          const cv::Mat2f &velocity, cv::Mat1f &objects)
{
    const MovedPlanes moved = move_planes(sweep, background, where, velocity);
    const Outlines outlines = outlines_of(inside);
    const std::vector<Surface> surfaces = surfaces_of(moved, outlines, noise);
    const std::vector<cv::Mat1f> colours = own_colours(moved, outlines);
    cv::Mat2f sums = cv::Mat2f::zeros(where.size());
    for (int y = 0; y < where.height; y++)
        for (int x = 0; x < where.width; x++)
            for (unsigned z = 0; z < sweep.planes() && std::fabs(outlines.depth(y, x)) < rim; z++)
                sums(y, x) += on_the_way(moved, colours, z, y, x);
    cv::blur(sums, sums, {3, 3});
    const float clear = clear_contrast * static_cast<float>(sweep.planes());
    for (int y = 0; y < where.height; y++)
        for (int x = 0; x < where.width; x++) {
            const float plain = surfaces[static_cast<size_t>(outlines.object(y, x))].plain;
            const cv::Vec2f &sum = sums(y, x);
            if (std::fabs(outlines.depth(y, x)) >= rim - 2.0F || sum[1] <= 0.0F)
                continue;
            const float found = 2.0F * (sum[0] / sum[1] - 0.5F) + 0.5F;
            objects(y, x) = std::lerp(objects(y, x), found, plain * sum[1] / (sum[1] + clear));
        }
}

} // namespace dff
