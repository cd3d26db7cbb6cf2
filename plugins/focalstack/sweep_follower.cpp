/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_follower.h"

#include "focalstack/in_parallel.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
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

/* Where the objects of a component are in a plane, `planes` before or after the middle of the sweep. */
class ObjectPath {
public:
    ObjectPath(const ObjectsOfComponent &objects, double farthest, double planes, const cv::Size &size)
        : from_(objects.where)
    {
        const int reach = static_cast<int>(std::ceil(farthest * objects.side * std::fabs(planes))) + 2;
        from_ -= cv::Point(reach, reach);
        from_ += cv::Size(2 * reach, 2 * reach);
        from_ &= cv::Rect({}, size);
        cv::Mat2f path(objects.where.size());
        const auto time = static_cast<float>(planes);
        for (int y = 0; y < path.rows; y++) {
            const cv::Vec2f *velocity = objects.velocity[y];
            cv::Vec2f *out = path[y];
            const auto row = static_cast<float>(y + objects.where.y - from_.y);
            const auto first = static_cast<float>(objects.where.x - from_.x);
            for (int x = 0; x < path.cols; x++)
                out[x] = {first + static_cast<float>(x) + time * velocity[x][0], row + time * velocity[x][1]};
        }
        cv::convertMaps(path, {}, pixels_, parts_, CV_16SC2);
    }

    /* The plane's picture where they are in the middle of the sweep: what they show, or what is behind them.
     */
    cv::Mat moved(const cv::Mat &picture) const
    {
        cv::Mat moved;
        cv::remap(picture(from_), moved, pixels_, parts_, cv::INTER_LINEAR, cv::BORDER_REFLECT);
        return moved;
    }

private:
    cv::Rect from_; /* pixels of the picture that are needed */
    cv::Mat pixels_, parts_;
};

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
                                             const DenoiseReport &noise, uint64_t absent)
{
    std::swap(small_, last_);
    noise_ = small_noise(noise);
    background_.follow(pictures_of(view, memory), small_, last_, noise_, absent);
    hold_tiles();
    return holds_ ? std::span<const uint8_t>(held_) : std::span<const uint8_t>();
}

cv::Size SweepFollower::tiles() const
{
    return {static_cast<int>(shape_.width + tile_pixels - 1) / tile_pixels,
            static_cast<int>(shape_.height + tile_pixels - 1) / tile_pixels};
}

/* A tile is kept if any of its pixels or of its neighbours' is: what comes near there next sweep must not
 * find the background forgotten. It is filled wherever that is known, with the same noise as around it. */
void SweepFollower::hold_tiles()
{
    const Silhouettes &found = background_.found();
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

    held_.resize(static_cast<size_t>(tiles().area()) * shape_.planes);
    const int around = 2 * std::max(tile_pixels / small_.factor(), 1); /* the neighbours' pixels */
    filled_where_ = cv::Rect(found.where.x - around, found.where.y - around, found.where.width + 2 * around,
                             found.where.height + 2 * around) &
                    cv::Rect({}, small_.size());
    std::vector<uint8_t> is_any(shape_.planes);
    in_parallel(shape_.planes, [&](unsigned z) { is_any[z] = hold_tiles(z); });
    holds_ = std::ranges::count(is_any, 0) < static_cast<std::ptrdiff_t>(shape_.planes);
}

/* Gives whether there are any in plane z. */
bool SweepFollower::hold_tiles(unsigned z)
{
    const Silhouettes &found = background_.found();
    const cv::Mat1b held = found.held[z](found.where);
    if (cv::countNonZero(held) == 0)
        return false;
    const auto tile_of = [this](int at) { return at * small_.factor() / tile_pixels; };
    cv::Mat1b plane(tiles().height, tiles().width,
                    held_.data() + size_t{z} * static_cast<size_t>(tiles().area()));
    for (int y = 0; y < held.rows; y++)
        for (int x = 0; x < held.cols; x++)
            plane(tile_of(y + found.where.y), tile_of(x + found.where.x)) |= held(y, x);
    cv::dilate(plane, plane, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
    for (int y = filled_where_.y; y < filled_where_.y + filled_where_.height; y++)
        for (int x = filled_where_.x; x < filled_where_.x + filled_where_.width; x++)
            filled_[z](y, x) = found.known[z](y, x) & plane(tile_of(y), tile_of(x));
    return true;
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
    std::optional<ObjectPath> path;
    cv::Mat moved;
    if (!objects.where.empty()) {
        path.emplace(objects, motion.farthest, z - middle_of_sweep(shape_.planes), picture.size());
        moved = path->moved(picture);
    }
    if (!fill.where.empty())
        blend(picture(fill.where), cv::Mat(fill.where.size(), picture.type(), fill.background.samples.data()),
              fill.share);
    if (!path)
        return;
    const PlaneOfObjects plane = {moved, path->moved(picture),
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
    const size_t planes = shape_.planes, components = shape_.components().size();
    std::vector<ObjectsOfComponent> objects(components);
    std::vector<Fill> fills(components * planes);
    std::vector<BackgroundPart> parts(fills.size());
    in_parallel(components + fills.size(), [&](unsigned i) {
        if (i < components) {
            objects[i] = objects_of(i, motion);
            return;
        }
        const size_t at = i - components;
        fills[at] = fill_of(at / planes, static_cast<unsigned>(at % planes), motion);
        parts[at] = fills[at].background;
    });
    denoiser.background(parts);
    const auto pictures = pictures_of(view, memory);
    in_parallel(fills.size(), [&](unsigned at) {
        const size_t c = at / planes, z = at % planes;
        fills[at].background.samples = std::move(parts[at].samples);
        compose(pictures[z][c], static_cast<unsigned>(z), motion, objects[c], fills[at]);
    });
}

} // namespace dff
