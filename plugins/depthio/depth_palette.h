/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace dff {

using Colour = std::array<uint8_t, 3>; /* red, green, blue */

enum class DepthPalette { Turbo, Jet, Gray, Hue };

/* Black: what no palette gives a known depth. */
constexpr Colour no_value_colour{0, 0, 0};

/* Colours of depth: position 0 is near and warm (white in Gray), position 1 is far. Turbo and Jet are
 * OpenCV's colour maps. Gray keeps clear of black, which is "no value".
 *
 * Hue goes along five edges of the colour cube, red - yellow - green - cyan - blue - magenta, in 1275 steps:
 * the colours of Sonoda and Grunnet-Jepsen, "Depth image compression by colorization for Intel RealSense
 * Depth Cameras" (rev. 1.0), without their sixth edge back to red. Closed, their circle turns the nearest
 * depth into the farthest by the slightest noise; open, noise at its ends runs into the gap. */
class PaletteColours {
public:
    explicit PaletteColours(DepthPalette palette);

    Colour at(double position) const;

private:
    DepthPalette palette_;
    std::array<Colour, 256> map_{};
};

/* The position of a Hue colour that went through a lossy codec; empty for "no value". Only the ratio of the
 * channels counts, so that a wrong brightness does no harm; brightness below half is "no value". */
std::optional<double> hue_position(Colour colour);

} // namespace dff
