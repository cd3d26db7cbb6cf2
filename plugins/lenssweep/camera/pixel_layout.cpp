/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "pixel_layout.h"

#include <algorithm>
#include <cstring>

namespace dff {

namespace {

constexpr PixelLayout layouts[] = {
    {"Mono8", "video/x-raw", "GRAY8", 1, 0},      {"BayerRG8", "video/x-bayer", "rggb", 1, 0},
    {"BayerGR8", "video/x-bayer", "grbg", 1, 0},  {"BayerGB8", "video/x-bayer", "gbrg", 1, 0},
    {"BayerBG8", "video/x-bayer", "bggr", 1, 0},  {"RGB8", "video/x-raw", "RGB", 3, 0},
    {"RGB8Packed", "video/x-raw", "RGB", 3, 0},   {"BGR8", "video/x-raw", "BGR", 3, 0},
    {"BGR8Packed", "video/x-raw", "BGR", 3, 0},   {"Mono16", "video/x-raw", "GRAY16_LE", 2, 0},
    {"Mono12", "video/x-raw", "GRAY16_LE", 2, 4}, {"Mono10", "video/x-raw", "GRAY16_LE", 2, 6},
};

template <typename Matches> const PixelLayout *find(Matches matches)
{
    const auto *found = std::find_if(std::begin(layouts), std::end(layouts), matches);
    return found == std::end(layouts) ? nullptr : found;
}

/* A sample is two bytes, the low one first, at any address. */
void shift_row(const std::uint8_t *from, std::uint8_t *to, std::size_t samples, unsigned shift)
{
    for (std::size_t i = 0; i < samples; i++) {
        const unsigned sample = (from[2 * i] | unsigned{from[2 * i + 1]} << 8U) << shift;
        to[2 * i] = static_cast<std::uint8_t>(sample);
        to[2 * i + 1] = static_cast<std::uint8_t>(sample >> 8U);
    }
}

} // namespace

bool PixelLayout::is_bayer() const
{
    return std::string_view(media_type) == "video/x-bayer";
}

std::span<const PixelLayout> pixel_layouts()
{
    return layouts;
}

const PixelLayout *layout_of_camera(std::string_view genicam)
{
    return find([&](const PixelLayout &layout) { return genicam == layout.genicam; });
}

const PixelLayout *layout_of_caps(std::string_view media_type, std::string_view format)
{
    return find([&](const PixelLayout &layout) {
        return media_type == layout.media_type && format == layout.format;
    });
}

void copy_picture(const PixelLayout &layout, unsigned width, unsigned height,
                  std::span<const std::uint8_t> from, std::span<std::uint8_t> to)
{
    const std::size_t row = std::size_t{width} * layout.bytes;
    for (std::size_t y = 0; y < height; y++) {
        const std::uint8_t *source = from.data() + y * row;
        std::uint8_t *target = to.data() + y * layout.stride(width);
        if (layout.shift == 0)
            std::memcpy(target, source, row);
        else
            shift_row(source, target, row / 2, layout.shift);
    }
}

} // namespace dff
