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

/* Normal deviates, drawn once: to draw them for each frame would take longer than a frame lasts. */
const cv::Mat1f &deviates()
{
    static const cv::Mat1f table = [] {
        cv::Mat1f normal(1, 1 << 20);
        cv::RNG(1).fill(normal, cv::RNG::NORMAL, 0.0, 1.0);
        return normal;
    }();
    return table;
}

/* A row takes its deviates from anywhere in the table, or their negatives: of two frames' rows one in two
 * million has the same. */
void add_noise(cv::Mat1f values, const SensorNoise &noise, uint64_t seed)
{
    const auto last = static_cast<uint64_t>(deviates().cols - values.cols);
    const int from = static_cast<int>((seed >> 1) % last);
    cv::Mat1f deviation;
    cv::max(values, 0.0, deviation);
    deviation.convertTo(deviation, CV_32F, noise.gain, noise.read * noise.read);
    cv::sqrt(deviation, deviation);
    cv::multiply(deviation, deviates().colRange(from, from + values.cols), deviation,
                 seed % 2 == 0 ? 1.0 : -1.0);
    values += deviation;
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
