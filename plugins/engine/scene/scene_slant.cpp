/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_slant.h"

#include "engine/scene/palette.h"
#include "engine/scene/seeds.h"
#include "engine/scene/texture.h"

namespace dff {

Scene make_slant(cv::Size size, uint64_t seed)
{
    /* The texture's coarsest wave is 64 pixels long, its finest 2. */
    constexpr double coarsest = 64.0;
    const FractalNoise light(mix_seed(seed, 0), 2.0 / coarsest, 0.9);
    const FractalNoise hue(mix_seed(seed, 1), 0.25);
    Scene scene{cv::Mat3b(size), cv::Mat1f(size), {}};
    cv::parallel_for_(cv::Range(0, size.height), [&](const cv::Range &range) {
        for (int y = range.start; y < range.end; y++)
            for (int x = 0; x < size.width; x++) {
                const cv::Vec3d point(x / coarsest, y / coarsest, 0.5);
                scene.color(y, x) = to_pixel(rainbow(hue(point / 4.0)) * (0.15 + 0.8 * light(point)));
                scene.depth(y, x) = size.height > 1
                                        ? 1.0F - static_cast<float>(y) / static_cast<float>(size.height - 1)
                                        : 0.0F;
            }
    });
    return scene;
}

} // namespace dff
