/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/stream_depth.h"

#include "depthio/depth_range.h"

#include <cmath>
#include <stdexcept>

namespace dff {

GstDepthInfo depth_of(GstBuffer *frame, const GstCaps *caps)
{
    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    depth.scale = 1.0;
    if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(frame)) {
        gst_depth_meta_get_depth(meta, &depth);
        return depth;
    }
    if (!gst_depth_info_from_caps(&depth, caps) || depth.unit != GST_DEPTH_UNIT_DIOPTRE)
        return depth;
    if (std::isnan(depth.near) || std::isnan(depth.far))
        throw std::invalid_argument(
            "The caps say depth-unit=dioptre, but neither they nor a meta say which: set "
            "depth-near and depth-far in the caps");
    const DepthScale scale = dioptre_scale(depth.near, depth.far);
    depth.scale = scale.scale;
    depth.offset = scale.offset;
    return depth;
}

DepthScale scale_of(const GstDepthInfo &depth)
{
    DepthUnit unit = DepthUnit::Index;
    if (depth.unit == GST_DEPTH_UNIT_DIOPTRE)
        unit = DepthUnit::Dioptre;
    else if (depth.unit == GST_DEPTH_UNIT_MILLIMETRE)
        unit = DepthUnit::Millimetre;
    else if (depth.unit == GST_DEPTH_UNIT_MICROMETRE)
        unit = DepthUnit::Micrometre;
    return {unit, depth.scale, depth.offset};
}

} // namespace dff
