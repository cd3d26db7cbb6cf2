/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_statistics.h"

namespace dff {

void DepthStatistics::install_property(GObjectClass *object_class, guint id)
{
    g_object_class_install_property(
        object_class, id,
        g_param_spec_boxed(
            "stats", "Stats",
            "Stacks so far, those without any depth, milliseconds the last one took, whole and for each "
            "stage, and the part of its residual that the solver left",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

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
