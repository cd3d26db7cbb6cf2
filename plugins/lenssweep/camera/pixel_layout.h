/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dff {

/* How a camera's pixel format is called and laid out here. */
struct PixelLayout {
    const char *genicam;    /* the camera's name of it */
    const char *media_type; /* "video/x-raw" or "video/x-bayer" */
    const char *format;     /* in caps */
    unsigned bytes;         /* a pixel */
    unsigned shift;         /* to the left, which makes it full 16-bit scale */

    bool is_bayer() const;

    /* Of a row here: a multiple of four, as GStreamer has it. */
    std::size_t stride(unsigned width) const { return (std::size_t{width} * bytes + 3) / 4 * 4; }

    /* Whether the camera's memory can be used as it is; its rows follow each other without padding. */
    bool usable_in_place(unsigned width) const
    {
        return shift == 0 && stride(width) == std::size_t{width} * bytes;
    }
};

/* All that are known, the best first: more bits do not make the depth better, but frames larger. */
std::span<const PixelLayout> pixel_layouts();

/* By a camera's or the caps' name; null if it is not known. */
const PixelLayout *layout_of_camera(std::string_view genicam);
const PixelLayout *layout_of_caps(std::string_view media_type, std::string_view format);

/* Copies a picture whose rows follow each other without padding into rows of layout.stride(), scaling. The
 * padding is not touched. `from` and `to` hold as many bytes as that takes. */
void copy_picture(const PixelLayout &layout, unsigned width, unsigned height,
                  std::span<const std::uint8_t> from, std::span<std::uint8_t> to);

} // namespace dff
