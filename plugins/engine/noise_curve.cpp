/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/noise_curve.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace dff {

namespace {

constexpr size_t brightnesses = std::tuple_size_v<NoiseCurve>;
constexpr size_t enough = 100;             /* values of one brightness */
constexpr double looked_at = 6000.0;       /* pixels a plane */
constexpr double normal_quartile = 0.3186; /* of |x|, x normal with a standard deviation of 1 */
constexpr double chi_median = 0.4549;      /* of x^2 */

using Values = std::array<std::vector<float>, brightnesses>;

double white(const Component &component)
{
    return component.sample_bytes == 2 ? 65536.0 : 256.0;
}

size_t brightness_bin(double brightness, double white)
{
    const double bin = brightness / white * brightnesses;
    return static_cast<size_t>(std::clamp(bin, 0.0, brightnesses - 1.0));
}

float quantile(std::vector<float> &values, double place)
{
    const auto nth =
        values.begin() + static_cast<std::ptrdiff_t>(place * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

/* Brightnesses that are not to be seen get the value of the nearest that are. */
std::optional<NoiseCurve> completed(const std::array<std::optional<float>, brightnesses> &known)
{
    NoiseCurve curve{};
    bool has_any = false;
    for (size_t i = 0; i < brightnesses; i++) {
        for (size_t distance = 0; distance < brightnesses; distance++) {
            const bool below = i >= distance && known[i - distance];
            const bool above = i + distance < brightnesses && known[i + distance];
            if (!below && !above)
                continue;
            curve[i] = below ? *known[i - distance] : *known[i + distance];
            has_any = true;
            break;
        }
    }
    return has_any ? std::optional(curve) : std::nullopt;
}

float sample_at(const StackView &view, const RowLayout &rows, const Component &component, uint32_t x,
                uint32_t y)
{
    const std::byte *at =
        view.memory.data() + rows.offset + rows.stride * y + size_t{x} * component.sample_bytes;
    if (component.sample_bytes == 1)
        return static_cast<float>(*at);
    uint16_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return value;
}

} // namespace

float variance_at(const NoiseCurve &curve, float brightness)
{
    const float last = static_cast<float>(curve.size()) - 1.0F;
    const float place = std::clamp(brightness * (last + 1.0F) / 256.0F - 0.5F, 0.0F, last);
    const auto i = std::min(static_cast<size_t>(place), curve.size() - 2);
    return std::lerp(curve[i], curve[i + 1], place - static_cast<float>(i));
}

float most_mean(float samples, float spread, float sigmas)
{
    return sigmas * std::sqrt(spread / samples);
}

float most_square(float samples, float spread, float sigmas)
{
    const float part = 2.0F / 9.0F * spread / samples;
    const float root = 1.0F - part + sigmas * (5.0F / 6.0F) * std::sqrt(part);
    return root * root * root;
}

NoiseCurve noise_of_plane(const StackView &view, size_t index, uint32_t z)
{
    const Component component = view.shape.components()[index];
    const RowLayout &rows = view.layout[index * view.shape.planes + z];
    const double pixels = static_cast<double>(component.width) * component.height;
    const auto step = static_cast<uint32_t>(std::max(std::sqrt(pixels / looked_at), 1.0));
    const uint32_t next = component.channels;
    Values responses;
    std::vector<float> all;
    for (uint32_t y = 1; y + 1 < component.height; y += step)
        for (uint32_t x = next; x + next < component.width; x += step) {
            const auto row = [&](uint32_t at) {
                return sample_at(view, rows, component, x - next, at) -
                       2.0F * sample_at(view, rows, component, x, at) +
                       sample_at(view, rows, component, x + next, at);
            };
            const float response = std::fabs(row(y - 1) - 2.0F * row(y) + row(y + 1));
            responses[brightness_bin(sample_at(view, rows, component, x, y), white(component))].push_back(
                response);
            all.push_back(response);
        }
    const auto variance = [](std::vector<float> &values) {
        const double sigma =
            quantile(values, 0.25) / 6.0 / normal_quartile; /* 36 is the kernel's noise gain */
        return static_cast<float>(sigma * sigma);
    };
    std::array<std::optional<float>, brightnesses> known;
    for (size_t i = 0; i < brightnesses; i++)
        if (responses[i].size() >= enough)
            known[i] = variance(responses[i]);
    NoiseCurve flat{};
    if (!all.empty())
        flat.fill(variance(all));
    return completed(known).value_or(flat);
}

std::optional<NoiseCurve> noise_of_tiles(std::span<const TileDifference> tiles,
                                         std::span<const uint8_t> sweeps, const Component &component,
                                         float samples)
{
    Values squares;
    for (size_t i = 0; i < tiles.size(); i++)
        squares[brightness_bin(tiles[i].brightness, white(component))].push_back(
            tiles[i].square / (1.0F + 1.0F / std::max<float>(sweeps[i], 1.0F)));
    /* The mean square of n samples varies by sqrt(2 / n); its lower quartile lies 0.67 of that below the
     * mean. */
    const auto quartile = static_cast<float>(1.0 - 0.6745 * std::sqrt(2.0 / samples));
    std::array<std::optional<float>, brightnesses> known;
    for (size_t i = 0; i < brightnesses; i++)
        if (squares[i].size() >= enough)
            known[i] = quantile(squares[i], 0.25) / quartile;
    return completed(known);
}

float spread_of_tiles(std::span<const TileDifference> tiles, float samples)
{
    std::vector<float> ratios;
    for (const TileDifference &tile : tiles)
        if (tile.square > 0.0F)
            ratios.push_back(tile.mean * tile.mean * samples / tile.square);
    if (ratios.size() < enough)
        return 1.0F;
    return std::clamp(static_cast<float>(quantile(ratios, 0.5) / chi_median), 1.0F, samples / 2.0F);
}

} // namespace dff
