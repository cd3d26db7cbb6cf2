/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/frame_layout.h"

namespace dff {

GstClockTime frame_period(const GstVideoInfo &info)
{
    const gint numerator = GST_VIDEO_INFO_FPS_N(&info);
    return numerator > 0 ? gst_util_uint64_scale(GST_SECOND, GST_VIDEO_INFO_FPS_D(&info), numerator) : 0;
}

/* The format's planes, as Y and UV of NV12, with rows of so many bytes as their pixels need. */
static gsize tight_stride(const GstVideoInfo &info, guint plane)
{
    gint component[GST_VIDEO_MAX_COMPONENTS];
    gst_video_format_info_component(info.finfo, plane, component);
    return static_cast<gsize>(GST_VIDEO_INFO_COMP_WIDTH(&info, component[0]) *
                              GST_VIDEO_INFO_COMP_PSTRIDE(&info, component[0]));
}

static gsize tight_size(const GstVideoInfo &info)
{
    gsize size = 0;
    for (guint plane = 0; plane < GST_VIDEO_INFO_N_PLANES(&info); plane++) {
        gint component[GST_VIDEO_MAX_COMPONENTS];
        gst_video_format_info_component(info.finfo, plane, component);
        size +=
            tight_stride(info, plane) * static_cast<gsize>(GST_VIDEO_INFO_COMP_HEIGHT(&info, component[0]));
    }
    return size;
}

std::string describe_misfit(const GstVideoInfo &info, gsize size)
{
    const std::string expected = std::to_string(GST_VIDEO_INFO_SIZE(&info));
    std::string text = "it has " + std::to_string(size) + " bytes, and a picture of " +
                       std::to_string(GST_VIDEO_INFO_WIDTH(&info)) + "x" +
                       std::to_string(GST_VIDEO_INFO_HEIGHT(&info)) + " in " +
                       gst_video_format_to_string(GST_VIDEO_INFO_FORMAT(&info)) + " has " + expected;
    if (size != tight_size(info) || size == GST_VIDEO_INFO_SIZE(&info))
        return text;
    const std::string tight = std::to_string(tight_stride(info, 0));
    return text + ": its rows of " + tight +
           " bytes follow each other without a gap, where each must take a multiple of 4, " +
           std::to_string(GST_VIDEO_INFO_PLANE_STRIDE(&info, 0)) +
           " bytes (rawvideoparse with plane-strides=<" + tight + "> says so of them)";
}

} // namespace dff
