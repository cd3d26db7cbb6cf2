/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>

#include <optional>
#include <string>

/* The engine's kernels work on rows of 64 pixels or more, and are tried up to 16384. */
#define ENGINE_SIZES "width = (int) [ 64, 16384 ], height = (int) [ 64, 16384 ]"

#define STACK_CAPS_OF(sizes)                                                                                 \
    GST_FOCAL_STACK_CAPS_NAME                                                                                \
    ", format = (string) " GST_FOCAL_STACK_FORMATS ", " sizes                                                \
    ", planes = (int) [ 2, 64 ], framerate = (fraction) [ 0, max ]"

/* Pictures of other sizes come after those: whoever can scale does so, and the rest is told why it fails. */
#define ENGINE_STACK_CAPS                                                                                    \
    STACK_CAPS_OF(ENGINE_SIZES) "; " STACK_CAPS_OF("width = (int) [ 1, max ], height = (int) [ 1, max ]")

namespace dff {

/* What to tell a user whose pictures the engine does not take; nothing if it does. */
inline std::optional<std::string> wrong_size(const GstVideoInfo &frame)
{
    const int width = GST_VIDEO_INFO_WIDTH(&frame), height = GST_VIDEO_INFO_HEIGHT(&frame);
    constexpr int most = GST_FOCAL_STACK_MAX_SIDE;
    if (width >= 64 && width <= most && height >= 64 && height <= most)
        return std::nullopt;
    return "The pictures have " + std::to_string(width) + "x" + std::to_string(height) +
           " pixels; depth from focus takes 64x64 to 16384x16384: crop or scale the frames before they "
           "become stacks";
}

} // namespace dff
