/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depthio/picture_view.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace dff {

/* None lose depth. dwaa and dwab lose a little of the colours. */
enum class ExrCompression { None, Rle, Zips, Zip, Piz, Dwaa, Dwab };

using ExrAttribute = std::pair<std::string, std::variant<float, std::string, std::vector<float>>>;

/* One picture of a file: R, G, B in half precision, linear light, and, if there is depth, Z in single
 * precision, with uncertainty.Z if that is known too. */
struct ExrPart {
    std::string name;
    PictureView colour; /* 8-bit RGB */
    std::optional<PictureView> depth;
    std::optional<PictureView> uncertainty; /* one standard deviation of `depth`, in its pixels; 0: unknown */
    std::vector<ExrAttribute> attributes;
};

/* What all parts of a file share. */
struct ExrFormat {
    ExrCompression compression = ExrCompression::Zip;
    std::array<float, 256> linear{};  /* of each 8-bit value of the colours */
    std::span<const float> distances; /* of each depth pixel there can be, see distance_table() */
    std::span<const float> slopes;    /* likewise, see distance_slope_table() */
};

/* An OpenEXR file of parts of one size; one with several parts is a multi-part file. Throws std::exception if
 * memory runs out. */
std::vector<uint8_t> write_exr(std::span<const ExrPart> parts, const ExrFormat &format);

} // namespace dff
