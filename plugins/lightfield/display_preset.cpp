/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "display_preset.h"

#include <array>
#include <sstream>

namespace dff {

std::span<const DisplayPreset> display_presets()
{
    static constexpr double tall = 9.0 / 16.0, wide = 16.0 / 9.0;
    static constexpr std::array presets{
        DisplayPreset{"looking-glass-go", "Looking Glass Go", 11, 6, tall, {4092, 4092}},
        DisplayPreset{"looking-glass-portrait", "Looking Glass Portrait", 8, 6, 0.75, {3360, 3360}},
        DisplayPreset{"looking-glass-16", "Looking Glass 16\", landscape", 7, 7, wide, {5999, 5999}},
        DisplayPreset{"looking-glass-16-portrait", "Looking Glass 16\", portrait", 11, 6, tall, {5995, 6000}},
        DisplayPreset{"looking-glass-32", "Looking Glass 32\", landscape", 7, 7, wide, {8190, 8190}},
        DisplayPreset{"looking-glass-32-portrait", "Looking Glass 32\", portrait", 11, 6, tall, {8184, 8184}},
        DisplayPreset{"looking-glass-65", "Looking Glass 65\"", 8, 9, wide, {8192, 8192}},
    };
    return presets;
}

std::string quilt_suffix(unsigned columns, unsigned rows, double aspect)
{
    std::ostringstream suffix;
    suffix.imbue(std::locale::classic());
    suffix.precision(5);
    suffix << "_qs" << columns << "x" << rows << "a" << aspect;
    return suffix.str();
}

} // namespace dff
