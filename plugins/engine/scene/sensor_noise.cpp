/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/sensor_noise.h"

#include "engine/scene/seeds.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace dff {

namespace {

constexpr std::array<std::pair<std::string_view, SensorNoise>, 4> levels{{
    {"none", {0.0, 0.0}},
    {"mild", {0.05, 1.0}},
    {"moderate", {0.2, 2.0}},
    {"strong", {1.0, 5.0}},
}};

std::optional<double> parse_number(std::string_view text)
{
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !(number >= 0.0 && number <= 255.0))
        return std::nullopt;
    return number;
}

void add_noise(cv::Mat1f values, const SensorNoise &noise, uint64_t seed)
{
    cv::Mat1f normal(values.size());
    cv::RNG(seed).fill(normal, cv::RNG::NORMAL, 0.0, 1.0);
    const auto gain = static_cast<float>(noise.gain);
    const auto read_variance = static_cast<float>(noise.read * noise.read);
    float *value = values.ptr<float>();
    const float *draw = normal.ptr<float>();
    for (int i = 0; i < values.cols; i++)
        value[i] += draw[i] * std::sqrt(gain * std::max(value[i], 0.0F) + read_variance);
}

} // namespace

std::optional<SensorNoise> SensorNoise::parse(std::string_view text)
{
    for (const auto &[name, noise] : levels)
        if (name == text)
            return noise;
    const size_t comma = text.find(',');
    if (comma == std::string_view::npos)
        return std::nullopt;
    const auto gain = parse_number(text.substr(0, comma));
    const auto read = parse_number(text.substr(comma + 1));
    if (!gain || !read)
        return std::nullopt;
    return SensorNoise{*gain, *read};
}

cv::Mat3b SensorNoise::digitise(const cv::Mat3f &picture, uint64_t seed) const
{
    cv::Mat3b digital(picture.size());
    cv::parallel_for_(cv::Range(0, picture.rows), [&](const cv::Range &range) {
        for (int y = range.start; y < range.end; y++) {
            cv::Mat1f row = picture.row(y).clone().reshape(1);
            if (!silent())
                add_noise(row, *this, mix_seed(seed, static_cast<uint64_t>(y)));
            row.reshape(3).convertTo(digital.row(y), CV_8U);
        }
    });
    return digital;
}

} // namespace dff
