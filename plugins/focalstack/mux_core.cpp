/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/mux_core.h"

#include <bit>
#include <utility>

GST_DEBUG_CATEGORY_EXTERN(focalstackmux_debug);
#define GST_CAT_DEFAULT focalstackmux_debug

namespace dff {

namespace {

GstClockTime frame_period(const GstVideoInfo &info)
{
    const gint numerator = GST_VIDEO_INFO_FPS_N(&info);
    return numerator > 0 ? gst_util_uint64_scale(GST_SECOND, GST_VIDEO_INFO_FPS_D(&info), numerator) : 0;
}

GstFocalStackInfo stack_shape(const GstVideoInfo &frame, unsigned planes, unsigned frames_a_stack)
{
    GstFocalStackInfo shape{planes, frame};
    if (frames_a_stack > 1)
        gst_util_fraction_multiply(frame.fps_n, frame.fps_d, 1, static_cast<gint>(frames_a_stack),
                                   &shape.frame.fps_n, &shape.frame.fps_d);
    return shape;
}

bool same_shape(const GstFocalStackInfo &a, const GstFocalStackInfo &b)
{
    return a.planes == b.planes && gst_video_info_is_equal(&a.frame, &b.frame);
}

} // namespace

MuxInput &MuxCore::add_input(GstPad *pad, std::optional<unsigned> plane)
{
    if (plane)
        gate_.open(*plane);
    return inputs_.add(pad, plane);
}

void MuxCore::close_input(MuxInput &input)
{
    if (input.plane)
        gate_.close(*input.plane);
}

MuxStatistics MuxCore::statistics() const
{
    const std::lock_guard lock(facts_);
    return published_;
}

GstClockTime MuxCore::latency() const
{
    const std::lock_guard lock(facts_);
    return latency_;
}

void MuxCore::publish()
{
    const std::lock_guard lock(facts_);
    published_ = counting_;
}

bool MuxCore::start(const MuxSettings &settings)
{
    const std::lock_guard lock(stream_);
    settings_ = settings;
    counting_ = {};
    publish();
    output_.restart();
    own_stream_begun_ = false;
    inputs_.reset();
    {
        const std::lock_guard facts(facts_);
        latency_ = 0;
        origin_ns_.reset();
    }
    gate_.close_all();
    for (uint64_t linked = inputs_.linked_planes(); linked != 0; linked &= linked - 1)
        gate_.open(static_cast<unsigned>(std::countr_zero(linked)));
    gate_.let_in();
    return inputs_.make_sense(element_, settings_.planes);
}

void MuxCore::stop()
{
    const std::lock_guard lock(stream_);
    maker_.reset();
}

bool MuxCore::begin_flush(MuxInput &input)
{
    const std::lock_guard facts(facts_);
    if (!seeking_ || !input.plane) {
        gate_.shut();
        return true;
    }
    gate_.shut(*input.plane);
    if (std::exchange(flushed_, true))
        return false;
    origin_ns_.reset(); /* before any input numbers its first new frame */
    return true;
}

bool MuxCore::end_flush(MuxInput &input)
{
    const std::lock_guard lock(stream_);
    inputs_.reopen(input);
    input.numbering = {};
    gst_segment_init(&input.segment, GST_FORMAT_UNDEFINED);
    if (input.plane)
        gate_.open(*input.plane);
    const std::lock_guard facts(facts_);
    if (seeking_ && input.plane)
        return false;
    start_anew();
    gate_.let_in();
    origin_ns_.reset();
    return true;
}

void MuxCore::begin_seek()
{
    const std::lock_guard facts(facts_);
    seeking_ = true;
    flushed_ = false;
    gate_.hold();
}

bool MuxCore::end_seek()
{
    {
        const std::lock_guard facts(facts_);
        seeking_ = false;
        if (!flushed_) /* who pushes may be blocked downstream */
            return false;
    }
    const std::lock_guard lock(stream_);
    start_anew();
    return true;
}

void MuxCore::start_anew()
{
    maker_.reset();
    output_.restart();
}

void MuxCore::begin(MuxInput &input)
{
    const std::lock_guard lock(stream_);
    gst_segment_init(&input.segment, GST_FORMAT_UNDEFINED);
    inputs_.reopen(input);
    if (!input.plane)
        finish();
    else if (!std::exchange(own_stream_begun_, true))
        output_.begin_own_stream();
}

bool MuxCore::set_caps(MuxInput &input, const GstCaps *caps)
{
    input.has_caps = gst_video_info_from_caps(&input.info, caps);
    return input.has_caps;
}

void MuxCore::set_segment(MuxInput &input, const GstSegment &segment, guint32 seqnum)
{
    if (!input.plane && !gst_segment_is_equal(&input.segment, &segment)) {
        const std::lock_guard lock(stream_);
        finish();
        output_.set_segment(segment, seqnum);
    }
    gst_segment_copy_into(&segment, &input.segment);
}

bool MuxCore::pass_gap(MuxInput &input, GstEvent *gap)
{
    if (!input.plane) {
        const std::lock_guard lock(stream_);
        return output_.send_gap(gap);
    }
    TimeSpan time;
    gst_event_parse_gap(gap, &time.start, &time.duration);
    gst_event_unref(gap);
    const GstClockTime period = input.has_caps ? frame_period(input.info) : 0;
    if (GST_CLOCK_TIME_IS_VALID(time.duration) && time.duration > period)
        time.start += time.duration - period;
    time.start = gst_segment_to_running_time(&input.segment, GST_FORMAT_TIME, time.start);
    gate_.arrive(*input.plane, number(input, time));
    return true;
}

bool MuxCore::end(MuxInput &input)
{
    close_input(input);
    if (!inputs_.end(input))
        return false;

    const std::lock_guard lock(stream_);
    const uint64_t dropped = counting_.dropped;
    const uint64_t lost = counting_.lost;
    finish();
    if (counting_.lost > lost || counting_.dropped > dropped)
        GST_ELEMENT_WARNING(
            element_, STREAM, FAILED, ("The stream ended in mid-sweep."),
            ("%" G_GUINT64_FORMAT " planes did not come; %s", counting_.lost - lost,
             counting_.dropped > dropped ? "the stack was dropped" : "the stack was filled up and sent"));
    return true;
}

/* The sweep of a frame that comes on a pad of its own plane and has no meta. */
uint64_t MuxCore::number(MuxInput &input, const TimeSpan &time)
{
    const bool timed = GST_CLOCK_TIME_IS_VALID(time.start);
    uint64_t origin = 0;
    if (timed) {
        const std::lock_guard lock(facts_);
        if (!origin_ns_)
            origin_ns_ = time.start;
        origin = *origin_ns_;
    }
    return input.numbering.next(timed ? std::optional(time.start) : std::nullopt,
                                input.has_caps ? frame_period(input.info) : 0, origin);
}

bool MuxCore::place(MuxInput &input, GstBuffer *buffer, PlaneFrame &frame)
{
    const GstFocusMeta *meta = gst_buffer_get_focus_meta(buffer);
    if (!meta && !input.plane) {
        GST_ELEMENT_ERROR(element_, STREAM, WRONG_TYPE,
                          ("The frames do not say which plane of which sweep they are."),
                          ("Put lenssweeptag before this element, or link each plane's source to a pad "
                           "\"sink_0\", \"sink_1\", ... of its own."));
        return false;
    }

    frame.time = {GST_BUFFER_PTS(buffer), GST_BUFFER_DURATION(buffer)};
    if (!GST_CLOCK_TIME_IS_VALID(frame.time.duration) && frame_period(input.info) > 0)
        frame.time.duration = frame_period(input.info);
    gst_focus_info_init(&frame.focus);
    if (meta)
        gst_focus_meta_get_focus(meta, &frame.focus);
    if (!input.plane)
        return true;

    frame.time.start = gst_segment_to_running_time(&input.segment, GST_FORMAT_TIME, frame.time.start);
    frame.focus.plane = *input.plane;
    if (!meta)
        frame.focus.sweep = number(input, frame.time);
    return true;
}

/* A live source cannot be made to wait: there a sweep waits for later frames only. */
bool MuxCore::wait_for_others(MuxInput &input, uint64_t sweep)
{
    const bool live = input.is_live();
    gate_.arrive(*input.plane, sweep);
    return live || gate_.wait(*input.plane);
}

GstFlowReturn MuxCore::take(MuxInput &input, GstBuffer *buffer)
{
    PlaneFrame frame{buffer, nullptr, {}, {}};
    if (!input.has_caps)
        return GST_FLOW_NOT_NEGOTIATED;
    if (!place(input, buffer, frame))
        return GST_FLOW_ERROR;
    if (input.plane && !wait_for_others(input, frame.focus.sweep))
        return GST_FLOW_FLUSHING;

    const std::lock_guard lock(stream_);
    counting_.frames++;
    const GstFlowReturn flow = assemble(input, frame);
    publish();
    return flow;
}

/* Planes a stack, or 0 with the error posted. */
unsigned MuxCore::planes_for(const MuxInput &input, const GstFocusInfo &focus)
{
    unsigned planes = settings_.planes;
    if (planes == 0)
        planes = input.plane ? static_cast<unsigned>(std::bit_width(inputs_.linked_planes())) : focus.planes;
    else if (!input.plane && focus.planes != 0 && focus.planes != planes) {
        GST_ELEMENT_ERROR(
            element_, STREAM, FORMAT,
            ("The frames are of sweeps of %u planes, but planes=%u was asked for.", focus.planes, planes),
            ("Set planes=0 to go by the frames."));
        return 0;
    }

    if (planes < 2 || planes > longest_stack) {
        GST_ELEMENT_ERROR(element_, STREAM, FORMAT, ("A stack has 2 to 64 planes, not %u.", planes),
                          ("Set planes, or planes of the element that gives the frames their sweep."));
        return 0;
    }
    return planes;
}

GstFlowReturn MuxCore::assemble(MuxInput &input, PlaneFrame &frame)
{
    const unsigned planes = planes_for(input, frame.focus);
    if (planes == 0)
        return GST_FLOW_ERROR;
    if (frame.focus.plane >= planes) {
        refuse_damaged(frame, "its plane is not one of the sweep's");
        return GST_FLOW_OK;
    }
    const bool stack_a_frame = input.plane || settings_.window == StackWindow::Rolling;
    const GstFlowReturn flow = use_shape(stack_shape(input.info, planes, stack_a_frame ? 1 : planes));
    return flow == GST_FLOW_OK ? put(frame, input.info) : flow;
}

GstFlowReturn MuxCore::use_shape(const GstFocalStackInfo &shape)
{
    if (maker_ && same_shape(maker_->info(), shape))
        return GST_FLOW_OK;
    const GstFlowReturn flow = finish();
    if (flow != GST_FLOW_OK)
        return flow;
    if (!inputs_.make_sense(element_, settings_.planes))
        return GST_FLOW_ERROR;
    if (!output_.set_shape(shape))
        return GST_FLOW_NOT_NEGOTIATED;

    const unsigned allowance = inputs_.linked_planes() ? shape.planes - 1 : StackMaker::default_allowance;
    maker_ = StackMaker::create(settings_.window, shape, settings_.on_missing, allowance, counting_);
    update_latency(shape);
    return GST_FLOW_OK;
}

GstFlowReturn MuxCore::put(PlaneFrame &frame, const GstVideoInfo &info)
{
    GstVideoFrame picture;
    if (!gst_video_frame_map(&picture, &info, frame.buffer, GST_MAP_READ)) {
        refuse_damaged(frame, "it is shorter than its caps say");
        return GST_FLOW_OK;
    }
    frame.picture = &picture;
    const bool put = maker_->add(frame);
    frame.picture = nullptr;
    gst_video_frame_unmap(&picture);
    if (!put) {
        GST_ELEMENT_ERROR(
            element_, RESOURCE, NO_SPACE_LEFT, ("There is no memory for a focal stack."),
            ("%" G_GSIZE_FORMAT " bytes a stack", gst_focal_stack_info_get_size(&maker_->info())));
        return GST_FLOW_ERROR;
    }
    return send_outcomes();
}

void MuxCore::refuse_damaged(const PlaneFrame &frame, const char *why)
{
    counting_.damaged++;
    GST_ELEMENT_WARNING(element_, STREAM, DECODE, ("A damaged frame was left out."),
                        ("Plane %u of sweep %" G_GUINT64_FORMAT ", %" G_GSIZE_FORMAT " bytes: %s",
                         frame.focus.plane, frame.focus.sweep, gst_buffer_get_size(frame.buffer), why));
}

GstFlowReturn MuxCore::send_outcomes()
{
    publish();
    GstFlowReturn flow = GST_FLOW_OK;
    while (flow == GST_FLOW_OK) {
        auto outcome = maker_->next_outcome();
        if (!outcome)
            break;
        flow = output_.send(std::move(*outcome), counting_);
    }
    return flow;
}

GstFlowReturn MuxCore::finish()
{
    if (!maker_)
        return GST_FLOW_OK;
    maker_->finish();
    const GstFlowReturn flow = send_outcomes();
    maker_.reset();
    return flow;
}

/* A stack is sent when its last frame is there; one to be filled up waits for frames that may have been
 * overtaken. Planes on pads of their own come within one frame period. */
void MuxCore::update_latency(const GstFocalStackInfo &shape)
{
    const GstClockTime stack_period = frame_period(shape.frame);
    const bool rolling = settings_.window == StackWindow::Rolling;
    const bool side_by_side = inputs_.linked_planes() != 0;
    const GstClockTime period = side_by_side || rolling ? stack_period : stack_period / shape.planes;
    GstClockTime latency = side_by_side ? period : period * (shape.planes - 1);
    if (settings_.on_missing != OnMissing::Drop && !rolling)
        latency += side_by_side ? period : period * (StackMaker::default_allowance + 1);
    {
        const std::lock_guard lock(facts_);
        if (latency == std::exchange(latency_, latency))
            return;
    }
    gst_element_post_message(element_, gst_message_new_latency(GST_OBJECT(element_)));
}

} // namespace dff
