/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/depth_facts.h"

#include <algorithm>
#include <cmath>

namespace dff {

namespace {

void keep_if_known(std::vector<double> &values)
{
    if (std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }))
        values.clear();
}

GstDepthUnit unit_of(DepthUnit unit)
{
    switch (unit) {
    case DepthUnit::Dioptre:
        return GST_DEPTH_UNIT_DIOPTRE;
    case DepthUnit::Millimetre:
        return GST_DEPTH_UNIT_MILLIMETRE;
    case DepthUnit::Micrometre:
        return GST_DEPTH_UNIT_MICROMETRE;
    case DepthUnit::Index:
        break;
    }
    return GST_DEPTH_UNIT_INDEX;
}

} // namespace

PlanePositions plane_positions(const GstFocalStackInfo &info, GstBuffer *stack)
{
    g_autoptr(GError) error = nullptr;
    const GstFocalStackMeta *meta = gst_focal_stack_info_get_meta(&info, stack, &error);
    if (error)
        throw std::invalid_argument(error->message);
    PlanePositions positions;
    for (guint z = 0; meta && z < meta->planes; z++) {
        GstFocusInfo focus;
        gst_focal_stack_meta_get_focus(meta, z, &focus);
        positions.powers.push_back(focus.power);
        positions.positions_um.push_back(focus.position_um);
    }
    keep_if_known(positions.powers);
    keep_if_known(positions.positions_um);
    return positions;
}

DepthEncoder make_encoder(GstDepthUnit unit, unsigned planes, const PlanePositions &positions)
{
    if (unit == GST_DEPTH_UNIT_AUTO)
        unit = positions.powers.empty() ? GST_DEPTH_UNIT_INDEX : GST_DEPTH_UNIT_DIOPTRE;
    if (unit == GST_DEPTH_UNIT_INDEX)
        return DepthEncoder::index(planes);

    const bool in_dioptres = unit == GST_DEPTH_UNIT_DIOPTRE || unit == GST_DEPTH_UNIT_MILLIMETRE;
    if (in_dioptres && positions.powers.empty())
        throw UnknownPositions(
            "The unit needs the planes' powers in dioptres, which the stack does not say: set "
            "near and far on the source or on lenssweeptag, or use unit=index");
    if (!in_dioptres && positions.positions_um.empty())
        throw UnknownPositions(
            "The unit needs the planes' stage positions, which the stack does not say: use "
            "unit=index");
    if (unit == GST_DEPTH_UNIT_MICROMETRE)
        return DepthEncoder::micrometre(positions.positions_um);
    const SweepPlan plan = SweepPlan::at(positions.powers);
    return unit == GST_DEPTH_UNIT_DIOPTRE ? DepthEncoder::dioptre(plan) : DepthEncoder::millimetre(plan);
}

DepthEncoder encoder_of(const GstDepthInfo &depth, unsigned planes, const PlanePositions &positions)
{
    PlanePositions known = positions;
    if (known.powers.empty() && !std::isnan(depth.near) && !std::isnan(depth.far)) {
        const SweepPlan even = SweepPlan::even(planes, depth.near, depth.far);
        for (unsigned z = 0; z < planes; z++)
            known.powers.push_back(even.power(z));
    }
    const bool says_its_ends = depth.unit == GST_DEPTH_UNIT_DIOPTRE && depth.near > depth.far; /* NAN: no */
    if (says_its_ends && !known.powers.empty())
        return DepthEncoder::dioptre(SweepPlan::at(known.powers), depth.near, depth.far);
    return make_encoder(depth.unit, planes, known);
}

GstDepthInfo depth_info(const DepthEncoder &encoder, const PlanePositions &positions)
{
    GstDepthInfo info;
    gst_depth_info_init(&info);
    info.unit = unit_of(encoder.scale().unit);
    info.scale = encoder.scale().scale;
    info.offset = encoder.scale().offset;
    if (!positions.powers.empty()) {
        info.near = positions.powers.front();
        info.far = positions.powers.back();
    }
    return info;
}

} // namespace dff
