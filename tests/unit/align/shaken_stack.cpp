/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "shaken_stack.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace {

/* Rendered beyond the picture, so that its border shows more of the scene. */
constexpr int margin = 48;

cv::Mat1f make_texture(cv::Size size, cv::RNG &random)
{
    cv::Mat1f texture(size, 128.0F);

    for (const double sigma : {0.8, 2.0, 5.0}) {
        cv::Mat1f octave(size);
        random.fill(octave, cv::RNG::NORMAL, 0.0, 1.0);
        cv::GaussianBlur(octave, octave, {}, sigma);
        texture += octave * (15.0 * 2.0 * std::sqrt(CV_PI) * sigma);
    }
    return texture;
}

/* All alike. */
cv::Mat1f make_keys(cv::Size size, double period)
{
    cv::Mat1f keys(size);

    for (int y = 0; y < size.height; y++) {
        for (int x = 0; x < size.width; x++) {
            const bool gap = std::fmod(x, period) < 0.3 * period || std::fmod(y, period) < 0.3 * period;
            keys(y, x) = gap ? 60.0F : 180.0F;
        }
    }
    cv::GaussianBlur(keys, keys, {}, 0.8);
    return keys;
}

/* Gaussian blur whose circle of confusion grows with the distance from plane z; a disk of diameter c has the
 * variance of a Gaussian of sigma c / 4. */
cv::Mat1f focus_at(const cv::Mat1f &texture, double z, const Shaking &shaking)
{
    const auto circle_at = [&](int x) {
        return shaking.blur_step * std::abs((shaking.planes - 1.0) * x / (texture.cols - 1.0) - z);
    };
    cv::Mat1f picture(texture.size(), 0.0F);

    for (int level = 0; level < static_cast<int>(shaking.blur_step * shaking.planes) + 2; level++) {
        cv::Mat1f blurred;
        cv::GaussianBlur(texture, blurred, {}, std::max(level / 4.0, 1e-3));
        for (int x = 0; x < texture.cols; x++) {
            const double share = 1.0 - std::abs(circle_at(x) - level);
            if (share > 0.0)
                picture.col(x) += share * blurred.col(x);
        }
    }
    return picture;
}

void add_noise(cv::Mat1f &picture, const Shaking &shaking, cv::RNG &random)
{
    for (float &value : picture)
        value +=
            random.gaussian(std::sqrt(shaking.gain * std::max(value, 0.0F) + shaking.read * shaking.read));
}

} // namespace

ShakenStack::ShakenStack(const Shaking &shaking) : size(shaking.size)
{
    cv::RNG random(7);
    const cv::Size beyond(size.width + 2 * margin, size.height + 2 * margin);
    const cv::Mat1f texture =
        shaking.period > 0.0 ? make_keys(beyond, shaking.period) : make_texture(beyond, random);

    for (unsigned z = 0; z < shaking.planes; z++) {
        const double scale = 1.0 + shaking.breathing * (z / (shaking.planes - 1.0) - 0.5);
        const double angle = random.gaussian(shaking.rotation);
        const dff::PlaneWarp similarity(scale * std::cos(angle), scale * std::sin(angle),
                                        random.gaussian(shaking.jitter), random.gaussian(shaking.jitter));
        const double tilt = 2.0 * shaking.tilt / std::max(size.width, size.height);
        const cv::Matx33d perspective(1, 0, 0, 0, 1, 0, random.gaussian(tilt), random.gaussian(tilt), 1);
        const dff::PlaneWarp warp(similarity.matrix() * perspective);
        cv::Mat1f moved;
        cv::Mat plane;

        cv::warpPerspective(focus_at(texture, z, shaking), moved, warp.pixel_matrix(beyond), beyond,
                            cv::INTER_LANCZOS4, cv::BORDER_REFLECT_101);
        moved = moved(cv::Rect({margin, margin}, size)).clone();
        add_noise(moved, shaking, random);
        moved.convertTo(plane, CV_8U);
        planes.push_back(plane);
        warps.push_back(warp);
    }
}

double ShakenStack::residual(const std::vector<dff::PlaneWarp> &found, unsigned middle) const
{
    double worst = 0.0;

    for (std::size_t z = 0; z < warps.size(); z++) {
        double sum = 0.0;
        for (const double x : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
            for (const double y : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
                const cv::Point2d point(x * size.width, y * size.height);
                const double miss =
                    cv::norm(found[z].apply(warps[middle].apply(point)) - warps[z].apply(point));
                sum += miss * miss;
            }
        }
        worst = std::max(worst, std::sqrt(sum / 25.0));
    }
    return worst;
}
