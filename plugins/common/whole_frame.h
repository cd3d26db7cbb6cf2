/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/video.h>

namespace dff {

/* Whether a mapped frame is what its caps say, and all of its rows lie in the memory that was mapped.
 * gst_video_frame_map() believes a GstVideoMeta whatever size, offset and stride it names. */
inline bool is_whole(const GstVideoFrame &frame, const GstVideoInfo &caps)
{
    if (GST_VIDEO_FRAME_FORMAT(&frame) != GST_VIDEO_INFO_FORMAT(&caps) ||
        GST_VIDEO_FRAME_WIDTH(&frame) != GST_VIDEO_INFO_WIDTH(&caps) ||
        GST_VIDEO_FRAME_HEIGHT(&frame) != GST_VIDEO_INFO_HEIGHT(&caps))
        return false;
    for (guint i = 0; i < GST_VIDEO_FRAME_N_PLANES(&frame); i++) {
        gint components[GST_VIDEO_MAX_COMPONENTS];
        gst_video_format_info_component(frame.info.finfo, i, components);
        const gint first = components[0], stride = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, i);
        const gint64 row =
            gint64{GST_VIDEO_FRAME_COMP_WIDTH(&frame, first)} * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, first);
        const GstMapInfo &map = frame.map[frame.meta ? i : 0];
        const gint64 offset = static_cast<const guint8 *>(GST_VIDEO_FRAME_PLANE_DATA(&frame, i)) - map.data;
        const gint64 last = gint64{stride} * (GST_VIDEO_FRAME_COMP_HEIGHT(&frame, first) - 1);
        if (stride < row || offset < 0 || static_cast<guint64>(offset + last + row) > map.size)
            return false;
    }
    return true;
}

/* Maps a frame that is whole; false, and nothing is mapped, if it is not. gst_video_frame_map() calls it a
 * fault of the program, which is logged as critical, where a GstVideoMeta is smaller than the caps. */
inline bool map_whole(GstVideoFrame &frame, const GstVideoInfo &caps, GstBuffer *buffer, GstMapFlags flags)
{
    const GstVideoMeta *meta = gst_buffer_get_video_meta(buffer);
    if (meta && (meta->format != GST_VIDEO_INFO_FORMAT(&caps) ||
                 meta->width != static_cast<guint>(GST_VIDEO_INFO_WIDTH(&caps)) ||
                 meta->height != static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&caps))))
        return false;
    if (!gst_video_frame_map(&frame, &caps, buffer, flags))
        return false;
    if (is_whole(frame, caps))
        return true;
    gst_video_frame_unmap(&frame);
    return false;
}

} // namespace dff
