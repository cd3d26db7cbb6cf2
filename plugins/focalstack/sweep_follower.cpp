/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/sweep_follower.h"

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace dff {

namespace {

constexpr int tile_pixels = 8; /* of the denoiser */

/* Pixels of a component's picture that may change in one plane, and how they do. */
struct ObjectsOfComponent {
    cv::Rect where;
    double scale;       /* pixels of the component a pixel of the small pictures */
    cv::Mat2f velocity; /* a plane */
    cv::Mat1f objects;  /* 0 to 1 */
};

/* A small picture as pixels of a component, bilinear. */
cv::Mat enlarged(const cv::Mat &small, double scale, const cv::Size &size)
{
    const cv::Matx23d to_small(1.0 / scale, 0.0, 0.5 / scale - 0.5, 0.0, 1.0 / scale, 0.5 / scale - 0.5);
    cv::Mat large;
    cv::warpAffine(small, large, to_small, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    return large;
}

ObjectsOfComponent for_component(const ObjectMotion &motion, double scale, const cv::Size &size)
{
    ObjectsOfComponent objects;
    const int side = static_cast<int>(scale);
    const cv::Rect &small = motion.where;
    objects.where = cv::Rect(small.x * side, small.y * side, small.width * side, small.height * side) &
                    cv::Rect({}, size);
    objects.scale = scale;
    objects.velocity = enlarged(motion.velocity, scale, objects.where.size()) * scale;
    objects.objects = enlarged(motion.objects, scale, objects.where.size());
    objects.objects = cv::min(cv::max(objects.objects, 0.0F), 1.0F);
    return objects;
}

/* The plane's picture where its objects are in the middle of the sweep, `planes` before or after it. */
cv::Mat moved_picture(const cv::Mat &picture, const ObjectsOfComponent &objects, double farthest,
                      double planes)
{
    const int reach = static_cast<int>(std::ceil(farthest * objects.scale * std::fabs(planes))) + 2;
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
    cv::remap(picture(from), moved, path, {}, cv::INTER_LINEAR, cv::BORDER_REFLECT);
    return moved;
}

/* Where there is an object, the moved picture; where one passes, the background; else the picture itself. */
template <typename Sample>
void compose(cv::Mat picture, const cv::Mat &moved, const cv::Mat &background, const cv::Mat1f &objects,
             const cv::Mat1f &filled)
{
    const int channels = picture.channels();
    for (int y = 0; y < picture.rows; y++) {
        auto *out = picture.ptr<Sample>(y);
        const auto *following = moved.ptr<Sample>(y), *still = background.ptr<Sample>(y);
        for (int x = 0; x < picture.cols; x++) {
            const float object = objects(y, x), fill = filled(y, x);
            if (object <= 0.0F && fill <= 0.0F)
                continue;
            for (int i = x * channels; i < (x + 1) * channels; i++) {
                const float base = std::lerp(static_cast<float>(out[i]), static_cast<float>(still[i]), fill);
                out[i] = cv::saturate_cast<Sample>(std::lerp(base, static_cast<float>(following[i]), object));
            }
        }
    }
}

} // namespace

SweepFollower::SweepFollower(const StackShape &shape) : shape_(shape), small_(shape)
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

std::vector<uint8_t> SweepFollower::look(const StackView &view, std::span<std::byte> memory,
                                         const DenoiseReport &noise)
{
    small_.take(pictures_of(view, memory));
    silhouettes_ = background_.follow(small_, small_noise(noise));
    return held_tiles();
}

/* A tile is kept if any of its pixels or of its neighbours' is: what comes near there next sweep must not
 * find the background forgotten. It is filled wherever that is known, with the same noise as around it. */
std::vector<uint8_t> SweepFollower::held_tiles()
{
    const int across = static_cast<int>(shape_.width + tile_pixels - 1) / tile_pixels;
    const int down = static_cast<int>(shape_.height + tile_pixels - 1) / tile_pixels;
    std::vector<uint8_t> tiles(static_cast<size_t>(across * down) * shape_.planes);
    const auto tile_of = [this](int at) { return at * small_.factor() / tile_pixels; };
    filled_.clear();
    for (size_t z = 0; z < silhouettes_.held.size(); z++) {
        const cv::Mat1b &held = silhouettes_.held[z];
        filled_.emplace_back(cv::Mat1b::zeros(held.size()));
        if (cv::countNonZero(held) == 0)
            continue;
        cv::Mat1b plane(down, across, tiles.data() + z * static_cast<size_t>(across * down));
        for (int y = 0; y < held.rows; y++)
            for (int x = 0; x < held.cols; x++)
                plane(tile_of(y), tile_of(x)) |= held(y, x);
        cv::dilate(plane, plane, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
        for (int y = 0; y < held.rows; y++)
            for (int x = 0; x < held.cols; x++)
                filled_[z](y, x) = silhouettes_.known[z](y, x) & plane(tile_of(y), tile_of(x));
    }
    return tiles;
}

/* Where something passes in plane z, 0 to 1 as pixels of the component: it covers what is known. */
cv::Mat1f SweepFollower::filled(unsigned z, const ObjectMotion &motion, double scale,
                                const cv::Size &size) const
{
    cv::Mat1f passes;
    cv::Mat1b(filled_[z](motion.where) & (1 - motion.stands)).convertTo(passes, CV_32F, 2.0);
    return cv::min(cv::Mat1f(enlarged(passes, scale, size)), 1.0F);
}

void SweepFollower::follow_component(size_t c, const std::vector<std::vector<cv::Mat>> &pictures,
                                     const ObjectMotion &motion, StackDenoiser &denoiser) const
{
    const double scale = small_.factor() / static_cast<double>(shape_.components()[c].subsampling);
    const ObjectsOfComponent objects = for_component(motion, scale, pictures.front()[c].size());
    std::vector<cv::Mat> backgrounds;
    for (unsigned z = 0; z < shape_.planes; z++) {
        const cv::Mat &picture = pictures[z][c];
        cv::Mat rows(objects.where.height, picture.cols, picture.type());
        denoiser.background(c, z, static_cast<uint32_t>(objects.where.y),
                            {reinterpret_cast<std::byte *>(rows.data), rows.total() * rows.elemSize()});
        backgrounds.push_back(rows.colRange(objects.where.x, objects.where.x + objects.where.width));
    }
    cv::parallel_for_(cv::Range(0, static_cast<int>(shape_.planes)), [&](const cv::Range &range) {
        for (int i = range.start; i < range.end; i++) {
            const auto z = static_cast<unsigned>(i);
            const cv::Mat &picture = pictures[z][c];
            const cv::Mat moved =
                moved_picture(picture, objects, motion.farthest, z - middle_of_sweep(shape_.planes));
            const cv::Mat1f fill = filled(z, motion, scale, objects.where.size());
            if (picture.depth() == CV_16U)
                compose<uint16_t>(picture(objects.where), moved, backgrounds[z], objects.objects, fill);
            else
                compose<uint8_t>(picture(objects.where), moved, backgrounds[z], objects.objects, fill);
        }
    });
}

void SweepFollower::follow(const StackView &view, std::span<std::byte> memory, StackDenoiser &denoiser)
{
    if (silhouettes_.moved <= 0.0 || silhouettes_.is_whole)
        return;
    const ObjectMotion motion = find_motion(small_, silhouettes_);
    if (motion.where.empty())
        return;
    const auto pictures = pictures_of(view, memory);
    for (size_t c = 0; c < shape_.components().size(); c++)
        follow_component(c, pictures, motion, denoiser);
}

} // namespace dff
