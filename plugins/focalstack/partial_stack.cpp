/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/partial_stack.h"

#include "focalstack/frame_verdict.h"

#include <algorithm>
#include <utility>

namespace dff {

namespace {

/* Kernels read 16 pixels at a time, a little over both ends of a stack. */
constexpr gsize slack = 64;

std::shared_ptr<GstBuffer> reference_times(GstBuffer *frame)
{
    if (!gst_buffer_get_reference_timestamp_meta(frame, nullptr))
        return nullptr;
    std::shared_ptr<GstBuffer> holder(gst_buffer_new(), BufferUnref());
    copy_reference_times(frame, holder.get());
    return holder;
}

} // namespace

void copy_reference_times(GstBuffer *from, GstBuffer *to)
{
    gpointer state = nullptr;
    while (GstMeta *meta =
               gst_buffer_iterate_meta_filtered(from, &state, GST_REFERENCE_TIMESTAMP_META_API_TYPE)) {
        const auto *time = reinterpret_cast<GstReferenceTimestampMeta *>(meta);
        gst_buffer_add_reference_timestamp_meta(to, time->reference, time->timestamp, time->duration);
    }
}

std::optional<std::string> too_large(const GstFocalStackInfo &info)
{
    const uint64_t bytes = gst_focal_stack_info_get_size(&info), most = largest_picture();
    if (bytes <= most)
        return std::nullopt;
    g_autofree gchar *text =
        g_strdup_printf("A stack of %u planes of %dx%d %s has %" G_GUINT64_FORMAT
                        " bytes; on this machine it may have %" G_GUINT64_FORMAT
                        ", half of the memory: lower planes, or the width and height of the pictures",
                        info.planes, GST_VIDEO_INFO_WIDTH(&info.frame), GST_VIDEO_INFO_HEIGHT(&info.frame),
                        GST_VIDEO_INFO_NAME(&info.frame), bytes, most);
    return text;
}

StackPool::StackPool(const GstFocalStackInfo &info)
    : info_(info), pool_(gst_focal_stack_info_get_size(&info), slack)
{
}

BufferPtr StackPool::acquire()
{
    GstMemory *memory = pool_.acquire();
    if (!memory)
        return nullptr;
    GstBuffer *buffer = gst_buffer_new();
    gst_buffer_append_memory(buffer, memory);
    gst_focal_stack_info_add_video_metas(&info_, buffer);
    return BufferPtr(buffer);
}

PartialStack::PartialStack(const GstFocalStackInfo &info, BufferPtr buffer)
    : info_(info), buffer_(std::move(buffer)), planes_(info.planes)
{
    for (unsigned z = 0; z < info_.planes; z++) {
        gst_focus_info_init(&planes_[z].focus);
        planes_[z].focus.plane = z;
        planes_[z].focus.planes = info_.planes;
    }
}

/* Not by gst_video_frame_map_id(), which does not find a plane that begins 4 GiB before the stack's end:
 * gst_buffer_find_memory() counts the bytes behind it in 32 bits. */
bool PartialStack::put(unsigned plane, const PlaneFrame &frame)
{
    GstMapInfo map;
    if (!gst_buffer_map(buffer_.get(), &map, GST_MAP_WRITE))
        return false;
    const bool has_room = holds_all(map);
    if (has_room) {
        GstVideoFrame target{};
        target.info = info_.frame;
        for (guint i = 0; i < GST_VIDEO_INFO_N_PLANES(&info_.frame); i++)
            target.data[i] = map.data + GST_VIDEO_INFO_SIZE(&info_.frame) * plane +
                             GST_VIDEO_INFO_PLANE_OFFSET(&info_.frame, i);
        gst_video_frame_copy(&target, frame.picture);
    }
    gst_buffer_unmap(buffer_.get(), &map);
    planes_[plane] = {frame.focus, frame.time, reference_times(frame.buffer)};
    planes_[plane].focus.plane = plane;
    planes_[plane].focus.planes = info_.planes;
    return has_room;
}

void PartialStack::copy_picture(const PartialStack &other, unsigned from, unsigned to)
{
    const gsize size = GST_VIDEO_INFO_SIZE(&info_.frame);
    GstMapInfo source;
    GstMapInfo target;
    if (!gst_buffer_map(buffer_.get(), &target, GST_MAP_READWRITE))
        return;
    if (other.buffer_ == buffer_) {
        if (holds_all(target))
            std::copy_n(target.data + from * size, size, target.data + to * size);
    } else if (gst_buffer_map(other.buffer_.get(), &source, GST_MAP_READ)) {
        if (holds_all(target) && holds_all(source))
            std::copy_n(source.data + from * size, size, target.data + to * size);
        gst_buffer_unmap(other.buffer_.get(), &source);
    }
    gst_buffer_unmap(buffer_.get(), &target);
}

/* A stack that was sent may have been cut short by somebody downstream who then had it alone. */
bool PartialStack::holds_all(const GstMapInfo &map) const
{
    return map.size >= gst_focal_stack_info_get_size(&info_);
}

void PartialStack::repeat(unsigned from, unsigned to, double power)
{
    copy_picture(*this, from, to);
    planes_[to] = planes_[from];
    planes_[to].focus.plane = to;
    planes_[to].focus.power = power;
}

void PartialStack::take_over(const PartialStack &other, unsigned plane)
{
    copy_picture(other, plane, plane);
    planes_[plane] = other.planes_[plane];
}

void PartialStack::take_over(const PartialStack &other)
{
    for (unsigned z = 0; z < info_.planes; z++)
        take_over(other, z);
}

unsigned PartialStack::first_of(uint64_t fresh) const
{
    /* GST_CLOCK_TIME_NONE is greater than every time. */
    unsigned first = info_.planes;
    for (unsigned z = 0; z < info_.planes; z++)
        if ((fresh & plane_bit(z)) &&
            (first == info_.planes || planes_[z].time.start < planes_[first].time.start))
            first = z;
    return first;
}

TimeSpan PartialStack::span(uint64_t fresh) const
{
    const unsigned first = first_of(fresh);
    if (first == info_.planes || !GST_CLOCK_TIME_IS_VALID(planes_[first].time.start))
        return {};

    const GstClockTime start = planes_[first].time.start;
    GstClockTime end = start;
    for (unsigned z = 0; z < info_.planes; z++) {
        const TimeSpan &time = planes_[z].time;
        if ((fresh & plane_bit(z)) && GST_CLOCK_TIME_IS_VALID(time.start))
            end = std::max(end, time.start + (GST_CLOCK_TIME_IS_VALID(time.duration) ? time.duration : 0));
    }
    return {start, end > start ? end - start : GST_CLOCK_TIME_NONE};
}

BufferPtr PartialStack::finish(uint64_t sequence, uint64_t filled)
{
    const uint64_t fresh = all_planes(info_.planes) & ~filled;
    const TimeSpan time = span(fresh);
    GstBuffer *stack = buffer_.get();
    GST_BUFFER_PTS(stack) = time.start;
    GST_BUFFER_DURATION(stack) = time.duration;
    GST_BUFFER_OFFSET(stack) = sequence;

    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, sequence, info_.planes);
    meta->complete = filled == 0;
    meta->missing = filled;
    meta->repeated = filled;
    for (unsigned z = 0; z < info_.planes; z++)
        gst_focal_stack_meta_set_focus(meta, z, &planes_[z].focus);

    const unsigned first = first_of(fresh);
    if (first < info_.planes && planes_[first].clocks)
        copy_reference_times(planes_[first].clocks.get(), stack);
    return BufferPtr(gst_buffer_ref(stack));
}

} // namespace dff
