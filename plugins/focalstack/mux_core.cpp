/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/mux_core.h"

#include "focalstack/frame_layout.h"

#include <bit>
#include <utility>

GST_DEBUG_CATEGORY_EXTERN(focalstackmux_debug);
#define GST_CAT_DEFAULT focalstackmux_debug

namespace dff {

MuxInput &MuxCore::add_input(GstPad *pad, std::optional<unsigned> plane)
{
    return inputs_.add(pad, plane);
}

void MuxCore::open_input(MuxInput &input)
{
    inputs_.reopen(input);
    if (input.plane)
        gate_.open(*input.plane);
}

void MuxCore::close_input(MuxInput &input)
{
    if (!input.plane)
        return;
    if (inputs_.is_flushing(input)) /* whose FLUSH_STOP does not come any more */
        end_flush(input, gst_event_new_flush_stop(TRUE));
    gate_.close(*input.plane);
}

void MuxCore::release_input(MuxInput &input)
{
    inputs_.release(input);
    close_input(input);
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
    watch_ = {};
    publish();
    output_.restart();
    running_ = true;
    stream_begun_ = false;
    ended_ = false;
    damage_told_ = false;
    inputs_.reset();
    {
        const std::lock_guard facts(facts_);
        latency_ = 0;
        flush_ = Flush::None;
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
    running_ = false;
    maker_.reset();
}

/* Whether downstream has to be flushed, and is not yet. */
bool MuxCore::widen_flush(const MuxInput &input, FlushReach reach)
{
    const std::lock_guard facts(facts_);
    const bool begun = flush_ != Flush::None;
    if (seeking_ && !begun)
        origin_ns_.reset(); /* before any input numbers its first new frame */
    if (seeking_ || reach == FlushReach::Stream)
        flush_ = Flush::Stream;
    else if (reach == FlushReach::Downstream && !begun) {
        flush_ = Flush::Downstream;
        flushed_for_ = input.plane;
    }
    return !begun && flush_ != Flush::None;
}

void MuxCore::begin_flush(MuxInput &input, GstEvent *flush_start)
{
    bool downstream = true;
    if (input.plane) {
        gate_.hold(); /* nobody else begins to push while it is found out who does */
        const FlushReach reach = inputs_.begin_flush(input);
        gate_.shut(*input.plane);
        downstream = widen_flush(input, reach);
        if (!downstream)
            gate_.release();
    } else
        inputs_.begin_flush(input);
    GST_DEBUG_OBJECT(input.pad, "flushing %s", downstream ? "with all that follows" : "by itself");
    if (downstream)
        output_.push_event(flush_start);
    else
        gst_event_unref(flush_start);
}

/* What of the output this input's FLUSH_STOP ends to flush. */
MuxCore::Flush MuxCore::narrow_flush(const MuxInput &input)
{
    if (!input.plane)
        return Flush::Stream;
    const std::lock_guard facts(facts_);
    if (seeking_ || (flush_ == Flush::Downstream && flushed_for_ != input.plane))
        return Flush::None;
    if (flush_ == Flush::Stream)
        origin_ns_.reset();
    return std::exchange(flush_, Flush::None);
}

void MuxCore::end_flush(MuxInput &input, GstEvent *flush_stop)
{
    input.begin_stream();
    input.numbering = {};
    open_input(input);
    const Flush flush = narrow_flush(input);
    if (flush == Flush::None) {
        gst_event_unref(flush_stop);
        return;
    }
    {
        const std::lock_guard lock(stream_);
        if (flush == Flush::Stream)
            start_anew();
        else
            output_.resume();
    }
    if (flush == Flush::Downstream) { /* the time of the others runs on */
        GstEvent *in_time = gst_event_new_flush_stop(FALSE);
        gst_event_set_seqnum(in_time, gst_event_get_seqnum(flush_stop));
        gst_event_unref(flush_stop);
        flush_stop = in_time;
    }
    output_.push_event(flush_stop);
    if (input.plane)
        gate_.release();
}

void MuxCore::begin_seek()
{
    const std::lock_guard facts(facts_);
    seeking_ = true;
    gate_.hold();
}

void MuxCore::end_seek(guint32 seqnum)
{
    Flush flush = Flush::None;
    {
        const std::lock_guard facts(facts_);
        seeking_ = false;
        flush = std::exchange(flush_, Flush::None);
    }
    if (flush != Flush::None) { /* otherwise who pushes may be blocked downstream */
        const std::lock_guard lock(stream_);
        start_anew();
        GstEvent *stop = gst_event_new_flush_stop(TRUE);
        gst_event_set_seqnum(stop, seqnum);
        output_.push_event(stop);
        gate_.release(); /* that of the first flush */
    }
    gate_.release();
}

void MuxCore::start_anew()
{
    maker_.reset();
    output_.restart();
    ended_ = false;
}

void MuxCore::begin(MuxInput &input, GstEvent *stream_start)
{
    input.begin_stream();
    open_input(input);
    if (input.plane && stream_begun_ && !ended_) { /* without stream_, which others may have for long */
        gst_event_unref(stream_start);
        return;
    }
    const std::lock_guard lock(stream_);
    if (!input.plane) {
        finish(&input);
        output_.begin_stream(stream_start);
    } else {
        gst_event_unref(stream_start);
        if (!stream_begun_ || ended_) {
            output_.restart();
            output_.begin_own_stream();
        }
    }
    stream_begun_ = true;
    ended_ = false;
}

bool MuxCore::set_caps(MuxInput &input, const GstCaps *caps)
{
    GST_INFO_OBJECT(input.pad, "caps %" GST_PTR_FORMAT, caps);
    return inputs_.set_caps(input, caps);
}

void MuxCore::set_segment(MuxInput &input, const GstSegment &segment, guint32 seqnum)
{
    if (!input.plane && !gst_segment_is_equal(&input.segment, &segment)) {
        const std::lock_guard lock(stream_);
        finish(&input);
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
    time.start = input.running_time(time.start);
    gate_.arrive(*input.plane, number(input, time));
    return true;
}

void MuxCore::end(MuxInput &input, GstEvent *eos)
{
    GST_DEBUG_OBJECT(input.pad, "ended");
    inputs_.end(input);
    close_input(input);
    end_if_due(eos, &input);
}

bool MuxCore::end_is_due() const
{
    return running_ && stream_begun_ && !ended_ && inputs_.all_ended();
}

void MuxCore::end_if_due(GstEvent *eos, const MuxInput *last)
{
    if (end_is_due()) {
        const std::lock_guard lock(stream_);
        if (end_is_due()) {
            finish_and_tell(last);
            send_end(eos ? eos : gst_event_new_eos(), last);
            return;
        }
    }
    if (eos)
        gst_event_unref(eos);
}

/* Like a stack, an end may be held up by a sink that is paused. */
void MuxCore::send_end(GstEvent *eos, const MuxInput *last)
{
    if (!inputs_.begin_push(last)) {
        gst_event_unref(eos);
        return;
    }
    ended_ = true;
    output_.end(eos);
    inputs_.end_push();
}

void MuxCore::finish_and_tell(const MuxInput *input)
{
    const uint64_t dropped = counting_.dropped;
    const uint64_t lost = counting_.lost;
    finish(input);
    if (counting_.lost > lost || counting_.dropped > dropped)
        GST_ELEMENT_WARNING(
            element_, STREAM, FAILED, ("The stream ended in mid-sweep."),
            ("%" G_GUINT64_FORMAT " planes did not come; %s", counting_.lost - lost,
             counting_.dropped > dropped ? "the stack was dropped" : "the stack was filled up and sent"));
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

    frame.time.start = input.running_time(frame.time.start);
    frame.focus.plane = *input.plane;
    if (!meta)
        frame.focus.sweep = number(input, frame.time);
    return true;
}

/* Nobody gets more than one sweep ahead. Other caps begin only when the others, too, have brought all of the
 * old ones. A live source cannot be made to wait: there a sweep waits for later frames only. */
GatePass MuxCore::enter(MuxInput &input, uint64_t sweep)
{
    const uint64_t lead = std::exchange(input.caps_changed, false) ? 0 : 1;
    gate_.arrive(*input.plane, sweep);
    return gate_.enter(*input.plane, input.is_live() ? std::nullopt : std::optional(lead));
}

GstFlowReturn MuxCore::take(MuxInput &input, GstBuffer *buffer)
{
    PlaneFrame frame{buffer, nullptr, {}, {}};
    if (!input.has_caps)
        return GST_FLOW_NOT_NEGOTIATED;
    if (!place(input, buffer, frame))
        return GST_FLOW_ERROR;
    if (!input.plane)
        return take_placed(input, frame);

    const GatePass pass = enter(input, frame.focus.sweep);
    if (pass == GatePass::Shut)
        return GST_FLOW_FLUSHING;
    if (pass == GatePass::Closed)
        return GST_FLOW_OK;
    const GstFlowReturn flow = take_placed(input, frame);
    gate_.leave();
    return flow;
}

GstFlowReturn MuxCore::take_placed(MuxInput &input, PlaneFrame &frame)
{
    const std::lock_guard lock(stream_);
    GST_LOG_OBJECT(input.pad, "plane %u of sweep %" G_GUINT64_FORMAT ", %" GST_TIME_FORMAT, frame.focus.plane,
                   frame.focus.sweep, GST_TIME_ARGS(frame.time.start));
    if (input.plane) {
        if (const auto conflict = inputs_.arrive(input, frame.focus.sweep)) {
            GST_ELEMENT_ERROR(
                element_, STREAM, FORMAT, ("%s", conflict->c_str()),
                ("Put videoconvert, videoscale or videorate and one capsfilter before each pad."));
            return GST_FLOW_ERROR;
        }
    }
    counting_.frames++;
    const GstFlowReturn flow = assemble(input, frame);
    publish();
    warn_of_missing_stacks();
    return flow;
}

} // namespace dff
