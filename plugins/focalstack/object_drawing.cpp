/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/object_drawing.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

template <typename Sample> void blend_samples(cv::Mat picture, const cv::Mat &over, const cv::Mat1f &share)
{
    const int channels = picture.channels();
    for (int y = 0; y < picture.rows; y++) {
        auto *out = picture.ptr<Sample>(y);
        const auto *shown = over.ptr<Sample>(y);
        const float *part = share[y];
        for (int x = 0; x < picture.cols; x++) {
            if (part[x] <= 0.0F)
                continue;
            const float by = std::min(part[x], 1.0F);
            for (int i = x * channels; i < (x + 1) * channels; i++) {
                const auto from = static_cast<float>(out[i]);
                out[i] = cv::saturate_cast<Sample>(from + by * (static_cast<float>(shown[i]) - from));
            }
        }
    }
}

/* What is known of one pixel of an object, or beside it. */
struct Rim {
    float object; /* 0 to 1 */
    float share;
    float plain, noisy;
};

/* One sample: `own` is the object's colour there, `base` the background. */
float drawn(const Rim &rim, float moved, float behind, float own, float base)
{
    moved += rim.noisy * (behind + rim.share * (own - behind) - moved);
    const float seen_through = own + rim.plain * (base - own);
    const float within = moved + (1.0F - rim.share) * (seen_through - behind);
    const float beside = base + rim.plain * (moved - behind + rim.share * (behind - base));
    return beside + rim.object * (within - beside);
}

template <typename Sample>
void draw(cv::Mat picture, const PlaneOfObjects &plane, const ObjectsOfComponent &objects)
{
    const float unit = sizeof(Sample) == 2 ? 256.0F : 1.0F;
    const int channels = picture.channels(), shown = static_cast<int>(objects.colours.size());
    for (int y = 0; y < picture.rows; y++) {
        auto *out = picture.ptr<Sample>(y);
        const auto *from = plane.moved.ptr<Sample>(y), *passed = plane.behind.ptr<Sample>(y);
        for (int x = 0; x < picture.cols; x++) {
            const Rim rim = {std::clamp(objects.objects(y, x), 0.0F, 1.0F), plane.share(y, x),
                             objects.plain(y, x), plane.noisy(y, x)};
            if (rim.object <= 0.0F && (rim.share <= 0.0F || rim.plain <= 0.0F))
                continue;
            if (rim.object >= 1.0F && rim.share >= 1.0F && rim.noisy <= 0.0F) {
                std::copy_n(from + x * channels, channels, out + x * channels);
                continue;
            }
            for (int c = 0; c < shown; c++) {
                const int i = x * channels + c;
                out[i] = cv::saturate_cast<Sample>(
                    drawn(rim, static_cast<float>(from[i]), static_cast<float>(passed[i]),
                          objects.colours[static_cast<size_t>(c)](y, x) * unit, static_cast<float>(out[i])));
            }
            for (int i = x * channels + shown; i < (x + 1) * channels; i++)
                out[i] = from[i]; /* of RGBx and RGBA */
        }
    }
}

} // namespace

void blend(const cv::Mat &picture, const cv::Mat &over, const cv::Mat1f &share)
{
    if (picture.depth() == CV_16U)
        blend_samples<uint16_t>(picture, over, share);
    else
        blend_samples<uint8_t>(picture, over, share);
}

void draw_objects(const cv::Mat &picture, const PlaneOfObjects &plane, const ObjectsOfComponent &objects)
{
    if (picture.depth() == CV_16U)
        draw<uint16_t>(picture, plane, objects);
    else
        draw<uint8_t>(picture, plane, objects);
}

} // namespace dff
