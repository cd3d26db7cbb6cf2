/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_statistics.h"

namespace dff {

void DepthStatistics::add(const StackDepth &depth, bool known, GstClockTime compute_time)
{
    stacks_++;
    without_depth_ += !known;
    compute_time_ = compute_time;
    stages_ = depth.times();
    residual_ = depth.residual();
}

GstStructure *DepthStatistics::to_structure() const
{
    GstStructure *stats = gst_structure_new(
        "dffdepth-stats", "stacks", G_TYPE_UINT64, stacks_, "without-depth", G_TYPE_UINT64, without_depth_,
        "compute-ms", G_TYPE_DOUBLE, static_cast<gdouble>(compute_time_) / 1e6, nullptr);
    if (residual_)
        gst_structure_set(stats, "residual", G_TYPE_DOUBLE, static_cast<gdouble>(*residual_), nullptr);
    for (const auto &[stage, milliseconds] : stages_)
        gst_structure_set(stats, (stage + "-ms").c_str(), G_TYPE_DOUBLE, milliseconds, nullptr);
    return stats;
}

} // namespace dff
