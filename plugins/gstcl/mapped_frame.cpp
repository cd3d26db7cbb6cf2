/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/mapped_frame.h"

#include "common/whole_frame.h"

#include <stdexcept>

namespace dff {

MappedFrame::MappedFrame(const GstVideoInfo &info, GstBuffer *buffer, GstMapFlags flags)
{
    if (map_whole(frame_, info, buffer, flags))
        return;
    throw std::runtime_error(
        gst_buffer_get_video_meta(buffer)
            ? "A frame's GstVideoMeta has another size than its caps, or leads out of its memory"
            : "A frame's memory does not hold what its caps say");
}

std::span<std::byte> MappedFrame::memory() const
{
    const auto row_bytes = static_cast<size_t>(GST_VIDEO_FRAME_WIDTH(&frame_)) *
                           static_cast<size_t>(GST_VIDEO_FRAME_COMP_PSTRIDE(&frame_, 0));
    return {static_cast<std::byte *>(GST_VIDEO_FRAME_PLANE_DATA(&frame_, 0)),
            stride() * static_cast<size_t>(GST_VIDEO_FRAME_HEIGHT(&frame_) - 1) + row_bytes};
}

void require_size(const GstVideoInfo &depth, const GstVideoInfo &main, const char *name)
{
    if (GST_VIDEO_INFO_WIDTH(&depth) == GST_VIDEO_INFO_WIDTH(&main) &&
        GST_VIDEO_INFO_HEIGHT(&depth) == GST_VIDEO_INFO_HEIGHT(&main))
        return;
    g_autofree gchar *text = g_strdup_printf(
        "The depth map is %dx%d, the %s %dx%d: scale the depth with nearest-neighbour, or neither",
        GST_VIDEO_INFO_WIDTH(&depth), GST_VIDEO_INFO_HEIGHT(&depth), name, GST_VIDEO_INFO_WIDTH(&main),
        GST_VIDEO_INFO_HEIGHT(&main));
    throw std::runtime_error(text);
}

void stamp_picture(GstBuffer *picture, GstBuffer *timed, GstBuffer *main, guint64 number)
{
    GST_BUFFER_PTS(picture) = GST_BUFFER_PTS(timed);
    GST_BUFFER_DURATION(picture) = GST_BUFFER_DURATION(timed);
    GST_BUFFER_OFFSET(picture) = number;
    if (const GstReferenceTimestampMeta *clock = gst_buffer_get_reference_timestamp_meta(main, nullptr))
        gst_buffer_add_reference_timestamp_meta(picture, clock->reference, clock->timestamp, clock->duration);
}

} // namespace dff
