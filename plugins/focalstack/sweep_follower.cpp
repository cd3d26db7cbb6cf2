/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_follower.h"

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace dff {

namespace {

constexpr int tile_pixels = 8; /* of the denoiser */

/* A small picture as pixels of a component that is `side` times as large, bilinear. */
template <typename Pixel> cv::Mat_<Pixel> enlarged(const cv::Mat_<Pixel> &small, int side)
{
    cv::Mat_<Pixel> large;
    cv::resize(small, large, {}, side, side, cv::INTER_LINEAR);
    return large;
}

cv::Rect enlarged(const cv::Rect &small, int side)
{
    return {small.x * side, small.y * side, small.width * side, small.height * side};
}

/* The part of a small picture that shows after it was enlarged, within `size`. */
cv::Rect shown_part(const cv::Mat1b &mask)
{
    const cv::Rect set = cv::boundingRect(mask);
    if (set.empty())
        return {};
    return cv::Rect(set.x - 1, set.y - 1, set.width + 2, set.height + 2) & cv::Rect({}, mask.size());
}

/* Where objects are, or the blur of one without texture. */
cv::Mat1b drawn_part(const ObjectMotion &motion)
{
    cv::Mat1b drawn = motion.objects > 0.0F;
    for (const cv::Mat1f &share : motion.rims.share)
        drawn |= (motion.rims.plain > 0.0F) & (share > 0.0F);
    return drawn;
}

/* The plane's picture where its objects are in the middle of the sweep, `planes` before or after it: what
 * they show, or what is behind them. */
cv::Mat moved_picture(const cv::Mat &picture, const ObjectsOfComponent &objects, double farthest,
                      double planes, int interpolation)
{
    const int reach = static_cast<int>(std::ceil(farthest * objects.side * std::fabs(planes))) + 2;
    cv::Rect from = objects.where;
    from -= cv::Point(reach, reach);
    from += cv::Size(2 * reach, 2 * reach);
    from &= cv::Rect({}, picture.size());
    cv::Mat2f path(objects.where.size());
    const auto time = static_cast<float>(planes);
    for (int y = 0; y < path.rows; y++) {
        const cv::Vec2f *velocity = objects.velocity[y];
        cv::Vec2f *out = path[y];
        const auto row = static_cast<float>(y + objects.where.y - from.y);
        const auto first = static_cast<float>(objects.where.x - from.x);
        for (int x = 0; x < path.cols; x++)
            out[x] = {first + static_cast<float>(x) + time * velocity[x][0], row + time * velocity[x][1]};
    }
    cv::Mat moved;
    cv::remap(picture(from), moved, path, {}, interpolation, cv::BORDER_REFLECT);
    return moved;
}

} // namespace

SweepFollower::SweepFollower(const StackShape &shape) : shape_(shape), small_(shape), last_(shape)
{
    if (shape.planes < fewest_planes)
        throw std::invalid_argument("Motion is followed in sweeps of " + std::to_string(fewest_planes) +
                                    " planes or more");
}

StillBackground::Noise SweepFollower::small_noise(const DenoiseReport &report) const
{
    StillBackground::Noise noise(small_.channels());
    for (unsigned i = 0; i < small_.channels(); i++) {
        const size_t c = small_.component_of(i);
        if (c >= report.noise.size())
            continue;
        for (size_t brightness = 0; brightness < noise[i].size(); brightness++) {
            const double variance =
                static_cast<double>(variance_at(report.noise[c], static_cast<float>(brightness) + 0.5F));
            noise[i][brightness] = static_cast<float>(
                report.sample_unit *
                std::sqrt(variance * static_cast<double>(report.spread[c]) / small_.samples(i)));
        }
    }
    return noise;
}

std::span<const uint8_t> SweepFollower::look(const StackView &view, std::span<std::byte> memory,
                                             const DenoiseReport &noise)
{
    std::swap(small_, last_);
    small_.take(pictures_of(view, memory));
    noise_ = small_noise(noise);
    background_.follow(small_, last_, noise_);
    hold_tiles();
    return holds_ ? std::span<const uint8_t>(held_) : std::span<const uint8_t>();
}

/* A tile is kept if any of its pixels or of its neighbours' is: what comes near there next sweep must not
 * find the background forgotten. It is filled wherever that is known, with the same noise as around it. */
void SweepFollower::hold_tiles()
{
    const Silhouettes &found = background_.found();
    const int across = static_cast<int>(shape_.width + tile_pixels - 1) / tile_pixels;
    const int down = static_cast<int>(shape_.height + tile_pixels - 1) / tile_pixels;
    const auto tile_of = [this](int at) { return at * small_.factor() / tile_pixels; };
    filled_.resize(shape_.planes);
    for (cv::Mat1b &filled : filled_) {
        if (filled.size() != small_.size())
            filled = cv::Mat1b::zeros(small_.size());
        else if (!filled_where_.empty())
            filled(filled_where_).setTo(0);
    }
    filled_where_ = {};
    if (std::exchange(holds_, false))
        std::fill(held_.begin(), held_.end(), uint8_t{0});
    if (found.where.empty() || found.is_whole)
        return;

    held_.resize(static_cast<size_t>(across * down) * shape_.planes);
    const int around = 2 * std::max(tile_pixels / small_.factor(), 1); /* the neighbours' pixels */
    filled_where_ = cv::Rect(found.where.x - around, found.where.y - around, found.where.width + 2 * around,
                             found.where.height + 2 * around) &
                    cv::Rect({}, small_.size());
    for (unsigned z = 0; z < shape_.planes; z++) {
        const cv::Mat1b held = found.held[z](found.where);
        if (cv::countNonZero(held) == 0)
            continue;
        holds_ = true;
        cv::Mat1b plane(down, across, held_.data() + z * static_cast<size_t>(across * down));
        for (int y = 0; y < held.rows; y++)
            for (int x = 0; x < held.cols; x++)
                plane(tile_of(y + found.where.y), tile_of(x + found.where.x)) |= held(y, x);
        cv::dilate(plane, plane, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
        for (int y = filled_where_.y; y < filled_where_.y + filled_where_.height; y++)
            for (int x = filled_where_.x; x < filled_where_.x + filled_where_.width; x++)
                filled_[z](y, x) = found.known[z](y, x) & plane(tile_of(y), tile_of(x));
    }
}

/* What an object of the small pictures is in a component's. */
ObjectsOfComponent SweepFollower::objects_of(size_t component, const ObjectMotion &motion) const
{
    ObjectsOfComponent objects;
    objects.side = small_.factor() / static_cast<int>(shape_.components()[component].subsampling);
    const cv::Rect part = shown_part(drawn_part(motion));
    if (part.empty())
        return objects;
    objects.where = enlarged(part + motion.where.tl(), objects.side);
    objects.velocity = enlarged(cv::Mat2f(motion.velocity(part)), objects.side) * objects.side;
    objects.objects = enlarged(cv::Mat1f(motion.objects(part)), objects.side);
    objects.plain = enlarged(cv::Mat1f(motion.rims.plain(part)), objects.side);
    for (unsigned i = 0; i < small_.channels(); i++)
        if (small_.component_of(i) == component)
            objects.colours.push_back(enlarged(cv::Mat1f(motion.rims.colours[i](part)), objects.side));
    objects.part = part;
    return objects;
}

/* Where something passes in plane z it covers what is known: that takes its place. */
SweepFollower::Fill SweepFollower::fill_of(size_t component, unsigned z, const ObjectMotion &motion) const
{
    Fill fill{{component, z, 0, 0, 0, 0, {}}, {}, {}};
    const cv::Mat1b passes = filled_[z](motion.where) & (1 - motion.stands);
    const cv::Rect part = shown_part(passes);
    if (part.empty())
        return fill;
    const Component of = shape_.components()[component];
    const int side = small_.factor() / static_cast<int>(of.subsampling);
    cv::Mat1f share;
    passes(part).convertTo(share, CV_32F, 2.0);
    fill.share = enlarged(share, side);
    fill.where = enlarged(part + motion.where.tl(), side);
    fill.background.x = static_cast<uint32_t>(fill.where.x) * of.channels;
    fill.background.y = static_cast<uint32_t>(fill.where.y);
    fill.background.width = static_cast<uint32_t>(fill.where.width) * of.channels;
    fill.background.height = static_cast<uint32_t>(fill.where.height);
    return fill;
}

/* Where there is an object, the moved picture; where one passes, the background; else the picture itself. */
void SweepFollower::compose(const cv::Mat &picture, unsigned z, const ObjectMotion &motion,
                            const ObjectsOfComponent &objects, Fill &fill) const
{
    const double planes = z - middle_of_sweep(shape_.planes);
    cv::Mat moved;
    if (!objects.where.empty())
        moved = moved_picture(picture, objects, motion.farthest, planes, cv::INTER_LINEAR);
    if (!fill.where.empty())
        blend(picture(fill.where), cv::Mat(fill.where.size(), picture.type(), fill.background.samples.data()),
              fill.share);
    if (objects.where.empty())
        return;
    const cv::Mat behind = moved_picture(picture, objects, motion.farthest, planes, cv::INTER_LINEAR);
    const PlaneOfObjects plane = {moved, behind,
                                  enlarged(cv::Mat1f(motion.rims.share[z](objects.part)), objects.side),
                                  enlarged(cv::Mat1f(motion.rims.noisy[z](objects.part)), objects.side)};
    draw_objects(picture(objects.where), plane, objects);
}

void SweepFollower::follow(const StackView &view, std::span<std::byte> memory, StackDenoiser &denoiser)
{
    const Silhouettes &found = background_.found();
    if (found.moved <= 0.0 || found.is_whole)
        return;
    const ObjectMotion motion = find_motion(small_, background_, noise_);
    if (motion.where.empty())
        return;
    const size_t components = shape_.components().size();
    std::vector<ObjectsOfComponent> objects;
    std::vector<Fill> fills;
    std::vector<BackgroundPart> parts;
    for (size_t c = 0; c < components; c++) {
        objects.push_back(objects_of(c, motion));
        for (unsigned z = 0; z < shape_.planes; z++) {
            fills.push_back(fill_of(c, z, motion));
            parts.push_back(fills.back().background);
        }
    }
    denoiser.background(parts);
    const auto pictures = pictures_of(view, memory);
    cv::parallel_for_(cv::Range(0, static_cast<int>(fills.size())), [&](const cv::Range &range) {
        for (int i = range.start; i < range.end; i++) {
            const auto at = static_cast<size_t>(i);
            const size_t c = at / shape_.planes, z = at % shape_.planes;
            fills[at].background.samples = std::move(parts[at].samples);
            compose(pictures[z][c], static_cast<unsigned>(z), motion, objects[c], fills[at]);
        }
    });
}

} // namespace dff
