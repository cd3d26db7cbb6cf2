/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_maps.h"

#include <cstring>

namespace dff {

DepthMaps::DepthMaps(const std::vector<std::shared_ptr<DepthOutput>> &outputs, const GstVideoInfo &stack,
                     const GstDepthInfo &depth, const StreamSegment &segment)
    : stack_(stack)
{
    for (const std::shared_ptr<DepthOutput> &output : outputs) {
        if (!output->is_linked())
            continue;
        output->prepare(stack, depth, segment);
        GstVideoInfo info;
        gst_video_info_set_format(&info, output->format(), GST_VIDEO_INFO_WIDTH(&stack),
                                  GST_VIDEO_INFO_HEIGHT(&stack));
        Map map{output, output->acquire(), {}};
        if (!map.buffer)
            continue;
        if (output->format() == GST_VIDEO_FORMAT_GRAY16_LE)
            gst_buffer_add_depth_meta(map.buffer, &depth);
        /* Without a reference to the buffer, which then can still be given metas. */
        gst_video_frame_map(
            &map.frame, &info, map.buffer,
            static_cast<GstMapFlags>(int{GST_MAP_WRITE} | int{GST_VIDEO_FRAME_MAP_FLAG_NO_REF}));
        maps_.push_back(std::move(map));
    }
}

DepthMaps::~DepthMaps()
{
    for (Map &map : maps_) {
        gst_video_frame_unmap(&map.frame);
        gst_buffer_unref(map.buffer);
    }
}

DepthOutputs DepthMaps::outputs() const
{
    DepthOutputs outputs;
    for (const Map &map : maps_) {
        const OutputPicture picture{static_cast<std::byte *>(GST_VIDEO_FRAME_PLANE_DATA(&map.frame, 0)),
                                    static_cast<size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&map.frame, 0))};
        const gchar *name = GST_PAD_NAME(map.output->pad());
        if (g_str_equal(name, "sparse"))
            outputs.sparse = picture;
        else if (g_str_equal(name, "confidence"))
            outputs.confidence = picture;
        else if (g_str_equal(name, "motion"))
            outputs.motion = picture;
        else
            outputs.depth = picture;
    }
    return outputs;
}

void DepthMaps::blank()
{
    for (Map &map : maps_) {
        const auto stride = static_cast<size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&map.frame, 0));
        std::memset(GST_VIDEO_FRAME_PLANE_DATA(&map.frame, 0), 0,
                    stride * GST_VIDEO_FRAME_HEIGHT(&map.frame));
        GST_BUFFER_FLAG_SET(map.buffer, GST_BUFFER_FLAG_GAP);
        GST_BUFFER_FLAG_SET(map.buffer, GST_BUFFER_FLAG_CORRUPTED);
    }
}

void DepthMaps::stamp(GstBuffer *stack, guint64 index)
{
    const gint n = GST_VIDEO_INFO_FPS_N(&stack_), d = GST_VIDEO_INFO_FPS_D(&stack_);
    GstClockTime pts = GST_BUFFER_PTS(stack), duration = GST_BUFFER_DURATION(stack);
    if (!GST_CLOCK_TIME_IS_VALID(pts) && n > 0)
        pts = gst_util_uint64_scale(index, GST_SECOND * d, n);
    if (!GST_CLOCK_TIME_IS_VALID(duration) && n > 0)
        duration = gst_util_uint64_scale_int(GST_SECOND, d, n);

    const GstReferenceTimestampMeta *clock = gst_buffer_get_reference_timestamp_meta(stack, nullptr);
    for (Map &map : maps_) {
        GST_BUFFER_PTS(map.buffer) = pts;
        GST_BUFFER_DURATION(map.buffer) = duration;
        GST_BUFFER_OFFSET(map.buffer) = index;
        if (GST_BUFFER_IS_DISCONT(stack))
            GST_BUFFER_FLAG_SET(map.buffer, GST_BUFFER_FLAG_DISCONT);
        if (clock)
            gst_buffer_add_reference_timestamp_meta(map.buffer, clock->reference, clock->timestamp,
                                                    clock->duration);
    }
}

void DepthMaps::push(const std::function<void(GstPad *, GstFlowReturn)> &pushed)
{
    while (!maps_.empty()) {
        Map map = std::move(maps_.front());
        maps_.erase(maps_.begin());
        gst_video_frame_unmap(&map.frame);
        pushed(map.output->pad(), gst_pad_push(map.output->pad(), map.buffer));
    }
}

} // namespace dff
