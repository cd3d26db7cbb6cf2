/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/thin_lens_renderer.h"

#include "engine/scene/disk_kernel.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace dff {

namespace {

/* Below this weight the farthest layer says nothing about a pixel. */
constexpr float faintest = 1e-4F;

cv::Mat1i layers_of(const cv::Mat1f &depth, unsigned planes)
{
    cv::Mat1i layers(depth.size());
    for (int y = 0; y < depth.rows; y++)
        for (int x = 0; x < depth.cols; x++)
            layers(y, x) = layer_of(depth(y, x) * static_cast<float>(planes - 1));
    return layers;
}

/* Plane position of each layer from `nearest` to `farthest`: the mean of what lies in it. */
std::vector<double> positions_of(const cv::Mat1f &depth, const cv::Mat1i &layers, unsigned planes,
                                 int nearest, int farthest)
{
    std::vector<double> sums(static_cast<size_t>(farthest - nearest + 1)), pixels(sums.size());
    for (int y = 0; y < depth.rows; y++)
        for (int x = 0; x < depth.cols; x++) {
            const auto layer = static_cast<size_t>(layers(y, x) - nearest);
            sums[layer] += depth(y, x) * (planes - 1);
            pixels[layer]++;
        }
    for (size_t layer = 0; layer < sums.size(); layer++)
        sums[layer] /= std::max(pixels[layer], 1.0);
    return sums;
}

cv::Mat4f blur_patch(const LayerPatch &patch, const cv::Mat1f &kernel)
{
    const int reach = kernel.cols / 2;
    cv::Mat4f premultiplied(patch.color.size());
    for (int y = 0; y < premultiplied.rows; y++)
        for (int x = 0; x < premultiplied.cols; x++) {
            const cv::Vec3b &color = patch.color(y, x);
            premultiplied(y, x) =
                patch.reach(y, x) <= reach ? cv::Vec4f(color[0], color[1], color[2], 1.0F) : cv::Vec4f();
        }
    if (kernel.empty())
        return premultiplied;
    cv::Mat4f blurred;
    cv::filter2D(premultiplied, blurred, -1, kernel, {-1, -1}, 0.0, cv::BORDER_REFLECT);
    return blurred;
}

void fill(cv::Mat4f picture, const cv::Mat3b &sharp)
{
    for (int y = 0; y < picture.rows; y++)
        for (int x = 0; x < picture.cols; x++)
            picture(y, x) = {static_cast<float>(sharp(y, x)[0]), static_cast<float>(sharp(y, x)[1]),
                             static_cast<float>(sharp(y, x)[2]), 1.0F};
}

void lay_over(cv::Mat4f picture, const cv::Mat4f &layer)
{
    for (int y = 0; y < picture.rows; y++)
        for (int x = 0; x < picture.cols; x++)
            picture(y, x) = picture(y, x) * (1.0F - layer(y, x)[3]) + layer(y, x);
}

/* The farthest layer has nothing behind it: wherever it reaches it fills the pixel. */
void paint(cv::Mat4f picture, const cv::Mat4f &layer)
{
    for (int y = 0; y < picture.rows; y++)
        for (int x = 0; x < picture.cols; x++)
            if (layer(y, x)[3] > faintest)
                picture(y, x) = layer(y, x) * (1.0F / layer(y, x)[3]);
}

} // namespace

int layer_of(double u)
{
    return cvRound(u * ThinLensRenderer::layers_per_plane);
}

ThinLensRenderer::ThinLensRenderer(const Scene &scene, unsigned planes, double blur_step,
                                   const std::stop_token &stop)
    : sharp_(scene.color), blur_step_(blur_step)
{
    if (stop.stop_requested()) /* then the scene may not have been drawn to its end either */
        return;
    double shallowest = 0.0, deepest = 0.0;
    cv::minMaxIdx(scene.depth, &shallowest, &deepest);
    const double extent = std::max({1.0, deepest, 1.0 - shallowest});
    const double steps = (planes - 1) * extent;
    const double largest = blur_step * steps;
    if (largest > max_blur_diameter)
        throw std::invalid_argument("a blur of " + std::to_string(std::lround(largest)) +
                                    " pixels over the sweep is too much; choose a blur-step of at most " +
                                    std::to_string(max_blur_diameter / steps));
    nearest_ = layer_of(shallowest * (planes - 1));
    farthest_ = layer_of(deepest * (planes - 1));
    const cv::Mat1i layers = layers_of(scene.depth, planes);
    positions_ = positions_of(scene.depth, layers, planes, nearest_, farthest_);
    tiles_ = cut_scene(scene.color, layers, disk_reach(largest), stop);
}

void ThinLensRenderer::render_tile(const SceneTile &tile, const Layers &layers,
                                   const std::vector<cv::Mat1f> &kernels, cv::Mat4f &picture) const
{
    if (layers.farthest == farthest_)
        fill(picture(tile.where), sharp_(tile.where));
    for (const LayerPatch &patch : tile.patches) {
        if (patch.layer < layers.nearest || patch.layer > layers.farthest)
            continue;
        const cv::Rect touched = patch.where & tile.where;
        const cv::Mat4f blurred = blur_patch(patch, kernels[static_cast<size_t>(patch.layer - nearest_)]);
        const cv::Mat4f layer = blurred(touched - patch.where.tl());
        if (patch.layer == farthest_)
            paint(picture(touched), layer);
        else
            lay_over(picture(touched), layer);
    }
}

cv::Mat4f ThinLensRenderer::composite(double z, const Layers &layers, const cv::Rect &region,
                                      const std::stop_token &stop) const
{
    std::vector<cv::Mat1f> kernels;
    for (const double position : positions_)
        kernels.push_back(disk_kernel(blur_diameter(position, z)));

    cv::Mat4f picture(size(), cv::Vec4f());
    cv::parallel_for_(cv::Range(0, static_cast<int>(tiles_.size())), [&](const cv::Range &range) {
        for (int i = range.start; i < range.end && !stop.stop_requested(); i++) {
            const SceneTile &tile = tiles_[static_cast<size_t>(i)];
            if (!(tile.where & region).empty())
                render_tile(tile, layers, kernels, picture);
        }
    });
    return picture;
}

cv::Mat3f ThinLensRenderer::render(double z, const std::stop_token &stop) const
{
    cv::Mat3f picture;
    cv::cvtColor(composite(z, {nearest_, farthest_}, whole(), stop), picture, cv::COLOR_RGBA2RGB);
    return picture;
}

cv::Mat4f ThinLensRenderer::render_behind(double z, double u, const cv::Rect &region,
                                          const std::stop_token &stop) const
{
    return composite(z, {layer_of(u), farthest_}, region, stop);
}

cv::Mat4f ThinLensRenderer::render_before(double z, double u, const cv::Rect &region,
                                          const std::stop_token &stop) const
{
    return composite(z, {nearest_, layer_of(u) - 1}, region, stop);
}

cv::Mat4f ThinLensRenderer::render_between(double z, double nearest, double farthest, const cv::Rect &region,
                                           const std::stop_token &stop) const
{
    return composite(z, {layer_of(nearest), layer_of(farthest) - 1}, region, stop);
}

} // namespace dff
