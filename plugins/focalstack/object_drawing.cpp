/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/object_drawing.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

constexpr int run = 16; /* pixels that are looked at together: most of them show one thing alone */

template <typename Sample> void blend_pixel(Sample *out, const Sample *shown, float share, int channels)
{
    if (share <= 0.0F)
        return;
    const float by = std::min(share, 1.0F);
    for (int i = 0; i < channels; i++) {
        const auto from = static_cast<float>(out[i]);
        out[i] = cv::saturate_cast<Sample>(from + by * (static_cast<float>(shown[i]) - from));
    }
}

template <typename Sample> void blend_samples(cv::Mat picture, const cv::Mat &over, const cv::Mat1f &share)
{
    const int channels = picture.channels();
    for (int y = 0; y < picture.rows; y++) {
        auto *out = picture.ptr<Sample>(y);
        const auto *shown = over.ptr<Sample>(y);
        const float *part = share[y];
        for (int first = 0; first < picture.cols; first += run) {
            const int count = std::min(run, picture.cols - first);
            int is_any = 0, is_part = 0;
            for (int x = first; x < first + count; x++) {
                is_any |= static_cast<int>(part[x] > 0.0F);
                is_part |= static_cast<int>(part[x] < 1.0F);
            }
            if (!is_any)
                continue;
            if (!is_part)
                std::copy_n(shown + first * channels, count * channels, out + first * channels);
            for (int x = first; is_part && x < first + count; x++)
                blend_pixel(out + x * channels, shown + x * channels, part[x], channels);
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

/* What there is in a run of pixels. */
enum class Shown { Nothing, Object, Rim };

Shown shown_by(const float *object, const float *share, const float *plain, const float *noisy, int count)
{
    int is_any = 0, is_rim = 0;
    for (int x = 0; x < count; x++) {
        is_any |= static_cast<int>(object[x] > 0.0F) |
                  (static_cast<int>(share[x] > 0.0F) & static_cast<int>(plain[x] > 0.0F));
        is_rim |= static_cast<int>(object[x] < 1.0F) | static_cast<int>(share[x] < 1.0F) |
                  static_cast<int>(noisy[x] > 0.0F);
    }
    return !is_any ? Shown::Nothing : is_rim ? Shown::Rim : Shown::Object;
}

/* One pixel of a picture whose samples begin at `out`; `from` and `passed` are those of PlaneOfObjects. */
template <typename Sample>
void draw_pixel(Sample *out, const Sample *from, const Sample *passed, const Rim &rim,
                const ObjectsOfComponent &objects, cv::Point at, int channels)
{
    if (rim.object <= 0.0F && (rim.share <= 0.0F || rim.plain <= 0.0F))
        return;
    if (rim.object >= 1.0F && rim.share >= 1.0F && rim.noisy <= 0.0F) {
        std::copy_n(from, channels, out);
        return;
    }
    const float unit = sizeof(Sample) == 2 ? 256.0F : 1.0F;
    const int shown = static_cast<int>(objects.colours.size());
    for (int i = 0; i < shown; i++)
        out[i] = cv::saturate_cast<Sample>(
            drawn(rim, static_cast<float>(from[i]), static_cast<float>(passed[i]),
                  objects.colours[static_cast<size_t>(i)](at) * unit, static_cast<float>(out[i])));
    for (int i = shown; i < channels; i++)
        out[i] = from[i]; /* of RGBx and RGBA */
}

template <typename Sample>
void draw(cv::Mat picture, const PlaneOfObjects &plane, const ObjectsOfComponent &objects)
{
    const int channels = picture.channels();
    for (int y = 0; y < picture.rows; y++) {
        auto *out = picture.ptr<Sample>(y);
        const auto *from = plane.moved.ptr<Sample>(y), *passed = plane.behind.ptr<Sample>(y);
        const float *object = objects.objects[y], *share = plane.share[y], *plain = objects.plain[y],
                    *noisy = plane.noisy[y];
        for (int first = 0; first < picture.cols; first += run) {
            const int count = std::min(run, picture.cols - first);
            const Shown shown = shown_by(object + first, share + first, plain + first, noisy + first, count);
            if (shown == Shown::Object)
                std::copy_n(from + first * channels, count * channels, out + first * channels);
            for (int x = first; shown == Shown::Rim && x < first + count; x++)
                draw_pixel(out + x * channels, from + x * channels, passed + x * channels,
                           {std::clamp(object[x], 0.0F, 1.0F), share[x], plain[x], noisy[x]}, objects, {x, y},
                           channels);
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
