/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "feed.h"

#include <algorithm>
#include <gst/video/video.h>

namespace dff::walk {

namespace {

enum class Kind { Frames, Stacks, Depth };

GstCaps *frame_caps(Chance &chance, const Shape &shape)
{
    const auto *format =
        chance.of<const char *>({"GRAY8", "I420", "NV12", "RGB", "BGRx", "GRAY16_LE", "RGBA64_LE"});
    return gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, format, "width", G_TYPE_INT,
                               shape.width, "height", G_TYPE_INT, shape.height, "framerate",
                               GST_TYPE_FRACTION, 25, 1, "interlace-mode", G_TYPE_STRING, "progressive",
                               nullptr);
}

GstCaps *stack_caps(Chance &chance, const Shape &shape)
{
    const auto *format = chance.of<const char *>({"GRAY8", "I420", "RGB", "GRAY16_LE"});
    return gst_caps_new_simple(GST_FOCAL_STACK_CAPS_NAME, "format", G_TYPE_STRING, format, "width",
                               G_TYPE_INT, shape.width, "height", G_TYPE_INT, shape.height, "planes",
                               G_TYPE_INT, shape.planes, "framerate", GST_TYPE_FRACTION, 25, 1, nullptr);
}

GstCaps *depth_caps(Chance &chance, const Shape &shape)
{
    GstCaps *caps =
        gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, "GRAY16_LE", "width", G_TYPE_INT,
                            shape.width, "height", G_TYPE_INT, shape.height, "framerate", GST_TYPE_FRACTION,
                            25, 1, "interlace-mode", G_TYPE_STRING, "progressive", nullptr);
    if (chance.percent(70)) {
        GstDepthInfo info;
        gst_depth_info_init(&info);
        info.unit = chance.of({GST_DEPTH_UNIT_INDEX, GST_DEPTH_UNIT_DIOPTRE, GST_DEPTH_UNIT_MILLIMETRE});
        info.near = 5;
        info.far = 0.5;
        gst_depth_info_to_caps(&info, caps);
    }
    return caps;
}

GstCaps *caps_of(Kind kind, Chance &chance, const Shape &shape)
{
    switch (kind) {
    case Kind::Frames:
        return frame_caps(chance, shape);
    case Kind::Stacks:
        return stack_caps(chance, shape);
    default:
        return depth_caps(chance, shape);
    }
}

/* Bytes of one buffer of these caps; 0 if they are none of ours. */
gsize size_of(const GstCaps *caps)
{
    if (g_autoptr(GstFocalStackInfo) stack = gst_focal_stack_info_new_from_caps(caps))
        return gst_focal_stack_info_get_size(stack);
    GstVideoInfo info;
    return gst_video_info_from_caps(&info, caps) ? info.size : 0;
}

const std::vector<guint8> &noise()
{
    static const std::vector<guint8> bytes = [] {
        std::vector<guint8> made(1 << 16);
        guint32 state = 1;
        for (guint8 &byte : made) {
            state = state * 1664525 + 1013904223;
            byte = static_cast<guint8>(64 + (state >> 25));
        }
        return made;
    }();
    return bytes;
}

GstBuffer *noisy_buffer(gsize size, gsize offset)
{
    GstBuffer *buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
    while (size > 0) {
        const gsize part = std::min(size, noise().size());
        size -= part;
        gst_buffer_fill(buffer, size, noise().data() + offset % (noise().size() - part + 1), part);
    }
    return buffer;
}

} // namespace

Feed::Feed(GstPad *sink, Chance &chance, const Shape &shape)
    : chance_(chance), sink_(GST_PAD(gst_object_ref(sink))), pad_(gst_pad_new("feed", GST_PAD_SRC)),
      name_(GST_PAD_NAME(sink))
{
    gst_object_ref_sink(pad_);
    gst_pad_set_event_function_full(pad_, event_function, this, nullptr);
    gst_pad_link(pad_, sink_);
    caps_ = some_caps(shape, true);
    thread_ = std::thread([this] { run(); });
}

Feed::~Feed()
{
    stop();
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    changed_.notify_all();
    thread_.join();
    gst_pad_unlink(pad_, sink_);
    gst_object_unref(pad_);
    gst_object_unref(sink_);
    gst_clear_caps(&caps_);
}

void Feed::start()
{
    if (running_)
        return;
    gst_pad_set_active(pad_, TRUE);
    running_ = true;
    queue_stream_start();
}

void Feed::stop()
{
    if (!running_)
        return;
    running_ = false;
    clear_queue();
    gst_pad_set_active(pad_, FALSE);
    clear_queue();
    wait_idle();
}

void Feed::queue_stream_start()
{
    flow_ = GST_FLOW_OK;
    queue(GST_MINI_OBJECT_CAST(gst_event_new_stream_start(("walk-" + name_).c_str())));
    if (caps_)
        queue(GST_MINI_OBJECT_CAST(gst_event_new_caps(caps_)));
    queue_segment(chance_.percent(85) ? GST_FORMAT_TIME : GST_FORMAT_BYTES, 0);
}

void Feed::queue_segment(GstFormat format, GstClockTime base)
{
    GstSegment segment;
    gst_segment_init(&segment, format);
    segment.base = base;
    format_ = format;
    queue(GST_MINI_OBJECT_CAST(gst_event_new_segment(&segment)));
}

std::string Feed::new_caps(const Shape &shape, bool well_formed)
{
    gst_clear_caps(&caps_);
    caps_ = some_caps(shape, well_formed);
    queue(GST_MINI_OBJECT_CAST(gst_event_new_caps(caps_)));
    g_autofree gchar *text = gst_caps_to_string(caps_);
    return name_ + ": caps " + text;
}

std::string Feed::push(unsigned buffers, bool well_formed)
{
    for (unsigned i = 0; i < buffers; i++)
        queue(GST_MINI_OBJECT_CAST(some_buffer(well_formed)));
    return name_ + ": " + std::to_string(buffers) + " buffers" + (well_formed ? "" : ", some of them odd");
}

/* Gaps are of streams in time. */
std::string Feed::gap()
{
    if (format_ != GST_FORMAT_TIME)
        return name_ + ": no gap in bytes";
    queue(GST_MINI_OBJECT_CAST(gst_event_new_gap(count_ * 40 * GST_MSECOND, 40 * GST_MSECOND)));
    return name_ + ": gap";
}

std::string Feed::new_segment()
{
    queue_segment(chance_.percent(80) ? GST_FORMAT_TIME : GST_FORMAT_BYTES, chance_.below(3) * GST_SECOND);
    return name_ + ": segment in " + gst_format_get_name(format_);
}

std::string Feed::end()
{
    queue(GST_MINI_OBJECT_CAST(gst_event_new_eos()));
    return name_ + ": EOS";
}

void Feed::flush(bool reset_time, guint32 seqnum)
{
    if (!running_)
        return;
    clear_queue();
    GstEvent *start = gst_event_new_flush_start();
    gst_event_set_seqnum(start, seqnum);
    gst_pad_push_event(pad_, start);
    wait_idle();
    GstEvent *stop = gst_event_new_flush_stop(reset_time);
    gst_event_set_seqnum(stop, seqnum);
    gst_pad_push_event(pad_, stop);
    queue_stream_start(); /* it may have been in the queue */
}

std::string Feed::flush()
{
    const bool reset_time = chance_.percent(70);
    flush(reset_time, gst_util_seqnum_next());
    return name_ + ": flush" + (reset_time ? "" : ", time goes on");
}

void Feed::run()
{
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return over_ || !queue_.empty(); });
        if (over_)
            return;
        GstMiniObject *item = queue_.front();
        queue_.pop_front();
        busy_ = true;
        lock.unlock();
        push_item(item);
        lock.lock();
        busy_ = false;
        changed_.notify_all();
    }
}

/* After an error a source pushes nothing but its end. */
void Feed::push_item(GstMiniObject *item)
{
    const bool is_end = GST_IS_EVENT(item) && GST_EVENT_TYPE(item) == GST_EVENT_EOS;
    if (flow_ != GST_FLOW_OK && !is_end)
        gst_mini_object_unref(item);
    else if (GST_IS_EVENT(item))
        gst_pad_push_event(pad_, GST_EVENT_CAST(item));
    else
        flow_ = gst_pad_push(pad_, GST_BUFFER_CAST(item));
}

void Feed::queue(GstMiniObject *item)
{
    if (!running_) {
        gst_mini_object_unref(item);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        queue_.push_back(item);
    }
    changed_.notify_all();
}

void Feed::clear_queue()
{
    const std::lock_guard lock(mutex_);
    for (GstMiniObject *item : queue_)
        gst_mini_object_unref(item);
    queue_.clear();
}

void Feed::wait_idle()
{
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !busy_; });
}

/* Of some kind that the pad's template takes; of any kind if they need not be well formed. */
GstCaps *Feed::some_caps(const Shape &shape, bool well_formed)
{
    g_autoptr(GstCaps) taken = gst_pad_get_pad_template_caps(sink_);
    GstCaps *caps = nullptr;
    for (int i = 0; i < 40; i++) {
        const Kind kind = chance_.of({Kind::Frames, Kind::Stacks, Kind::Depth});
        gst_clear_caps(&caps);
        caps = caps_of(kind, chance_, shape);
        if (!well_formed || gst_caps_can_intersect(caps, taken))
            break;
    }
    return caps;
}

GstBuffer *Feed::some_buffer(bool well_formed)
{
    gsize size = caps_ ? size_of(caps_) : 100;
    if (!well_formed && chance_.percent(30))
        size = chance_.of<gsize>({0, 1, size / 2, size - std::min<gsize>(size, 1), size + 1, size * 2});
    GstBuffer *buffer = noisy_buffer(size, chance_.below(4096));
    if (well_formed || chance_.percent(80)) {
        GST_BUFFER_PTS(buffer) = count_ * 40 * GST_MSECOND;
        GST_BUFFER_DURATION(buffer) = 40 * GST_MSECOND;
    }
    if (!well_formed && chance_.percent(10))
        GST_BUFFER_PTS(buffer) = chance_.of<GstClockTime>({0, GST_SECOND << 20, GST_CLOCK_TIME_NONE});
    if (!well_formed && chance_.percent(10))
        GST_BUFFER_FLAG_SET(
            buffer, chance_.of({GST_BUFFER_FLAG_DISCONT, GST_BUFFER_FLAG_GAP, GST_BUFFER_FLAG_CORRUPTED}));
    if (chance_.percent(80))
        add_meta(buffer);
    if (!well_formed && chance_.percent(5))
        sweep_base_ = chance_.of<std::uint64_t>({0, 1000, G_MAXUINT64 - 1});
    count_++;
    return buffer;
}

void Feed::add_meta(GstBuffer *buffer)
{
    if (g_autoptr(GstFocalStackInfo) stack = caps_ ? gst_focal_stack_info_new_from_caps(caps_) : nullptr) {
        const guint planes = chance_.percent(95) ? stack->planes : 64;
        gst_buffer_add_focal_stack_meta(buffer, sweep_base_ + count_, planes);
    } else if (caps_ && gst_structure_has_field(gst_caps_get_structure(caps_, 0), "depth-unit")) {
        GstDepthInfo depth;
        gst_depth_info_init(&depth);
        gst_depth_info_from_caps(&depth, caps_);
        depth.sequence = sweep_base_ + count_;
        gst_buffer_add_depth_meta(buffer, &depth);
    } else {
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        focus.planes = 2;
        focus.plane = static_cast<guint>(count_ % 2);
        focus.sweep = sweep_base_ + count_ / 2;
        focus.power = chance_.percent(95) ? 5.0 - focus.plane : chance_.of<double>({INFINITY, NAN, -1});
        gst_buffer_add_focus_meta(buffer, &focus);
    }
}

/* A seek is what a file source makes of it. */
gboolean Feed::handle_event(GstEvent *event)
{
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK) {
        GstSeekFlags flags = GST_SEEK_FLAG_NONE;
        gst_event_parse_seek(event, nullptr, nullptr, &flags, nullptr, nullptr, nullptr, nullptr);
        if ((flags & GST_SEEK_FLAG_FLUSH) == 0) {
            new_segment();
        } else {
            flush(true, gst_event_get_seqnum(event));
            flushing_seeks_++;
        }
    }
    gst_event_unref(event);
    return TRUE;
}

gboolean Feed::event_function(GstPad *pad, GstObject *, GstEvent *event)
{
    return static_cast<Feed *>(pad->eventdata)->handle_event(event);
}

} // namespace dff::walk
