/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_tiles.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

namespace dff {

namespace {

constexpr int tile_size = 128;
constexpr uchar never = 255;

cv::Rect grow(const cv::Rect &rect, int margin, cv::Size picture)
{
    const cv::Rect grown(rect.x - margin, rect.y - margin, rect.width + 2 * margin, rect.height + 2 * margin);
    return grown & cv::Rect({}, picture);
}

/* Positions of the zero pixels of `outside` by their label. */
std::vector<cv::Point> label_positions(const cv::Mat1b &outside, const cv::Mat1i &labels)
{
    std::vector<cv::Point> positions;
    for (int y = 0; y < outside.rows; y++)
        for (int x = 0; x < outside.cols; x++)
            if (!outside(y, x)) {
                const auto label = static_cast<size_t>(labels(y, x));
                positions.resize(std::max(positions.size(), label + 1));
                positions[label] = {x, y};
            }
    return positions;
}

/* Continues the layer behind nearer ones as far as a blur of `max_reach` can uncover it. */
void extend_behind(LayerPatch &patch, const cv::Mat1b &outside, const cv::Mat1b &nearer, int max_reach)
{
    cv::Mat1f distance;
    cv::Mat1i labels;
    cv::distanceTransform(outside, distance, labels, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
    const std::vector<cv::Point> positions = label_positions(outside, labels);
    for (int y = 0; y < outside.rows; y++)
        for (int x = 0; x < outside.cols; x++) {
            /* The layer is continued one and a half pixels further than the blur reaches. */
            const int reach = std::max(0, static_cast<int>(std::ceil(distance(y, x) - 1.5F)));
            if (!nearer(y, x) || reach > max_reach)
                continue;
            patch.reach(y, x) = static_cast<uchar>(reach);
            patch.color(y, x) = patch.color(positions[static_cast<size_t>(labels(y, x))]);
        }
}

/* Keeps what lies in `keep`, and of that no more than the blur of its covered pixels can touch. */
LayerPatch crop(const LayerPatch &patch, const cv::Rect &keep, int max_reach)
{
    const cv::Rect inner = keep - patch.where.tl();
    const cv::Mat1b covered = patch.reach(inner) != never;
    const cv::Rect box = cv::boundingRect(covered);
    LayerPatch cropped{patch.layer, {}, {}, {}};
    if (box.empty())
        return cropped;
    const cv::Rect touched = grow(box, max_reach, keep.size());
    cropped.where = touched + keep.tl();
    cropped.color = patch.color(inner)(touched).clone();
    cropped.reach = patch.reach(inner)(touched).clone();
    return cropped;
}

SceneTile cut_tile(const cv::Mat3b &color, const cv::Mat1i &layers, const cv::Rect &where, int max_reach)
{
    SceneTile tile{where, {}};
    const cv::Rect seen = grow(where, max_reach, color.size());
    const cv::Rect sources = grow(where, 2 * max_reach + 2, color.size());
    const cv::Mat1i local = layers(sources);
    const std::set<int, std::greater<>> far_to_near(local.begin(), local.end());
    for (const int layer : far_to_near) {
        const cv::Mat1b outside = local != layer;
        const cv::Mat1b nearer = local < layer;
        LayerPatch patch{layer, sources, color(sources).clone(), outside.clone()};
        if (cv::countNonZero(nearer) > 0)
            extend_behind(patch, outside, nearer, max_reach);
        patch = crop(patch, seen, max_reach);
        if (!patch.where.empty())
            tile.patches.push_back(std::move(patch));
    }
    return tile;
}

} // namespace

std::vector<SceneTile> cut_scene(const cv::Mat3b &color, const cv::Mat1i &layers, int max_reach,
                                 const std::stop_token &stop)
{
    const int columns = (color.cols + tile_size - 1) / tile_size;
    const int rows = (color.rows + tile_size - 1) / tile_size;
    std::vector<SceneTile> tiles(static_cast<size_t>(columns * rows));
    cv::parallel_for_(cv::Range(0, columns * rows), [&](const cv::Range &range) {
        for (int i = range.start; i < range.end && !stop.stop_requested(); i++) {
            const cv::Rect square(i % columns * tile_size, i / columns * tile_size, tile_size, tile_size);
            tiles[static_cast<size_t>(i)] =
                cut_tile(color, layers, square & cv::Rect({}, color.size()), max_reach);
        }
    });
    if (stop.stop_requested())
        tiles.clear();
    return tiles;
}

} // namespace dff
