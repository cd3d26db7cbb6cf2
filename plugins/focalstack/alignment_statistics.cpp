/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/alignment_statistics.h"

#include <algorithm>
#include <numbers>

namespace dff {
namespace {

/* Row by row. */
void append_matrix(GstStructure *structure, const PlaneWarp &warp)
{
    GValue matrix = G_VALUE_INIT;

    gst_value_array_init(&matrix, 9);
    for (const double number : warp.matrix().val) {
        GValue value = G_VALUE_INIT;
        g_value_init(&value, G_TYPE_DOUBLE);
        g_value_set_double(&value, number);
        gst_value_array_append_and_take_value(&matrix, &value);
    }
    gst_structure_take_value(structure, "matrix", &matrix);
}

GstStructure *to_structure(const PlaneAlignment &plane)
{
    const double degrees = plane.warp.rotation() * 180.0 / std::numbers::pi;
    const cv::Point2d shift = plane.warp.shift();
    GstStructure *structure =
        gst_structure_new("plane", "dx", G_TYPE_DOUBLE, shift.x, "dy", G_TYPE_DOUBLE, shift.y, "scale",
                          G_TYPE_DOUBLE, plane.warp.scale(), "rotation", G_TYPE_DOUBLE, degrees, "trusted",
                          G_TYPE_BOOLEAN, plane.trusted, "blank", G_TYPE_BOOLEAN, plane.blank, nullptr);

    append_matrix(structure, plane.warp);
    return structure;
}

} // namespace

void AlignmentStatistics::add(std::vector<PlaneAlignment> planes, std::size_t bad_pixels)
{
    stacks_++;
    bad_pixels_ = bad_pixels;
    untrusted_planes_ += std::ranges::count(planes, false, &PlaneAlignment::trusted);
    planes_ = std::move(planes);
}

GstStructure *AlignmentStatistics::to_structure() const
{
    GValue planes = G_VALUE_INIT;
    gst_value_array_init(&planes, static_cast<guint>(planes_.size()));
    for (const PlaneAlignment &plane : planes_) {
        GValue value = G_VALUE_INIT;
        g_value_init(&value, GST_TYPE_STRUCTURE);
        g_value_take_boxed(&value, dff::to_structure(plane));
        gst_value_array_append_and_take_value(&planes, &value);
    }

    GstStructure *structure = gst_structure_new(
        "application/x-focalstackalign-stats", "stacks", G_TYPE_UINT64, stacks_, "untrusted-planes",
        G_TYPE_UINT64, untrusted_planes_, "bad-pixels", G_TYPE_UINT64, bad_pixels_, nullptr);
    gst_structure_take_value(structure, "planes", &planes);
    return structure;
}

std::string numbers_of(std::span<const PlaneAlignment> alignments, bool blank)
{
    std::string text;

    for (std::size_t z = 0; z < alignments.size(); z++) {
        if (!alignments[z].trusted && alignments[z].blank == blank)
            text += (text.empty() ? "" : ", ") + std::to_string(z);
    }
    return text;
}

} // namespace dff
