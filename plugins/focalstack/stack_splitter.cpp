/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_splitter.h"

#include "focalstack/frame_verdict.h"

#include <algorithm>

namespace dff {

void StackSplitter::set_shape(const GstFocalStackInfo &shape)
{
    shape_ = shape;
}

GstVideoInfo StackSplitter::frame_info() const
{
    GstVideoInfo frame = shape_.frame;
    gst_util_fraction_multiply(frame.fps_n, frame.fps_d, static_cast<gint>(shape_.planes), 1, &frame.fps_n,
                               &frame.fps_d);
    return frame;
}

void StackSplitter::begin(GstBuffer *stack)
{
    stack_ = stack;
    number_ = stacks_++;
    time_ = clock_.next(shape_.frame, GST_BUFFER_PTS(stack), GST_BUFFER_DURATION(stack));
}

void StackSplitter::set_time(GstBuffer *frame, unsigned plane) const
{
    if (!GST_CLOCK_TIME_IS_VALID(time_.duration)) {
        GST_BUFFER_PTS(frame) = plane == 0 ? time_.start : GST_CLOCK_TIME_NONE;
        return;
    }
    const GstClockTime begin = gst_util_uint64_scale(time_.duration, plane, shape_.planes);
    const GstClockTime end = gst_util_uint64_scale(time_.duration, plane + 1, shape_.planes);
    if (GST_CLOCK_TIME_IS_VALID(time_.start))
        GST_BUFFER_PTS(frame) = time_.start + begin;
    GST_BUFFER_DURATION(frame) = end - begin;
}

void StackSplitter::add_focus(GstBuffer *frame, unsigned plane) const
{
    const GstFocalStackMeta *meta = gst_focal_stack_info_get_meta(&shape_, stack_, nullptr);
    GstFocusInfo focus;
    if (!meta || !gst_focal_stack_meta_get_focus(meta, plane, &focus)) {
        gst_focus_info_init(&focus);
        focus.sweep = number_;
        focus.plane = plane;
        focus.planes = shape_.planes;
    }
    gst_buffer_add_focus_meta(frame, &focus);
    if (meta && ((meta->missing | meta->repeated) & plane_bit(plane)))
        GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_CORRUPTED);
}

BufferPtr StackSplitter::frame(unsigned plane, GError **error) const
{
    const unsigned components = GST_VIDEO_INFO_N_PLANES(&shape_.frame);
    gsize offset[GST_VIDEO_MAX_PLANES] = {};
    gint stride[GST_VIDEO_MAX_PLANES] = {};
    if (!gst_focal_stack_info_locate_plane(&shape_, stack_, plane, offset, stride, error))
        return nullptr;

    const gsize start = *std::min_element(offset, offset + components);
    gsize end = start + GST_VIDEO_INFO_SIZE(&shape_.frame);
    for (unsigned i = 0; i < components; i++) {
        const gsize rows = GST_VIDEO_SUB_SCALE(GST_VIDEO_FORMAT_INFO_H_SUB(shape_.frame.finfo, i),
                                               GST_VIDEO_INFO_HEIGHT(&shape_.frame));
        end = std::max(end, offset[i] + rows * stride[i]);
        offset[i] -= start;
    }
    end = std::min(end, gst_buffer_get_size(stack_));

    BufferPtr frame(gst_buffer_copy_region(stack_, GST_BUFFER_COPY_MEMORY, start, end - start));
    gst_buffer_add_video_meta_full(frame.get(), GST_VIDEO_FRAME_FLAG_NONE,
                                   GST_VIDEO_INFO_FORMAT(&shape_.frame), GST_VIDEO_INFO_WIDTH(&shape_.frame),
                                   GST_VIDEO_INFO_HEIGHT(&shape_.frame), components, offset, stride);
    if (!gst_buffer_get_parent_buffer_meta(frame.get()))
        gst_buffer_add_parent_buffer_meta(frame.get(), stack_);
    set_time(frame.get(), plane);
    add_focus(frame.get(), plane);
    return frame;
}

} // namespace dff
