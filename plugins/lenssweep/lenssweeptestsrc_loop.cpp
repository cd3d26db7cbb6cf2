/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweeptestsrc_private.h"

#include "common/checked_properties.h"
#include "stream_pad.h"

#include <functional>
#include <gst/video/video.h>
#include <stdexcept>
#include <string>
#include <utility>

static GstFlowReturn try_to_negotiate(GstLensSweepTestSrc *self)
{
    TestStream &stream = *self->state->stream;
    g_autoptr(GstCaps) templ = gst_pad_get_pad_template_caps(self->src_pad);
    g_autoptr(GstCaps) possible = stream.caps(templ);
    g_autoptr(GstCaps) wanted = gst_pad_peer_query_caps(self->src_pad, possible);
    g_autoptr(GstCaps) common = gst_caps_intersect_full(possible, wanted, GST_CAPS_INTERSECT_FIRST);
    if (gst_caps_is_empty(common)) {
        GST_ELEMENT_ERROR(
            self, STREAM, FORMAT,
            ("Nothing downstream takes these pictures. The frame rate is planes times rate; put a "
             "videoconvert behind this element for other formats."),
            ("possible caps are %" GST_PTR_FORMAT, possible));
        return GST_FLOW_ERROR;
    }
    g_autoptr(GstCaps) chosen = stream.fixate(static_cast<GstCaps *>(g_steal_pointer(&common)));
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, chosen)) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT,
                          ("These pictures are too large. Put a smaller width and height into a capsfilter "
                           "behind this element."),
                          ("caps are %" GST_PTR_FORMAT, chosen));
        return GST_FLOW_ERROR;
    }
    g_autoptr(GstCaps) complete = gst_video_info_to_caps(&info);
    if (!change_caps(self->src_pad, complete) || !caps_are_taken(self->src_pad))
        return GST_PAD_IS_FLUSHING(self->src_pad) ? GST_FLOW_FLUSHING : GST_FLOW_NOT_NEGOTIATED;
    GST_INFO_OBJECT(self, "pictures are %" GST_PTR_FORMAT, complete);
    stream.set_format(info);
    return GST_FLOW_OK;
}

/* A capsfilter may be set to other caps between its answer to what it takes and the caps that follow from it.
 * Ten times in a row is no coincidence any more. */
static GstFlowReturn negotiate(GstLensSweepTestSrc *self)
{
    GstFlowReturn flow = GST_FLOW_NOT_NEGOTIATED;
    for (int attempt = 0; attempt < 10 && flow == GST_FLOW_NOT_NEGOTIATED; attempt++)
        flow = try_to_negotiate(self);
    return flow;
}

/* A token that ends the rendering which begins now. */
static std::stop_token rendering_token(GstLensSweepTestSrc *self)
{
    GST_OBJECT_LOCK(self);
    std::stop_token token = self->state->stop.get_token();
    GST_OBJECT_UNLOCK(self);
    return token;
}

namespace {

/* Tells the application what it waits for: nothing in the first second, then once a second at most. */
class RenderProgress {
public:
    explicit RenderProgress(GstElement *element) : element_(element) {}
    RenderProgress(const RenderProgress &) = delete;
    RenderProgress &operator=(const RenderProgress &) = delete;

    ~RenderProgress()
    {
        if (told_)
            post(GST_PROGRESS_TYPE_COMPLETE, "The sweep is rendered");
    }

    void operator()(unsigned plane, unsigned planes)
    {
        const GstClockTime now = gst_util_get_timestamp();
        if (now < told_at_ + GST_SECOND || plane + 1 == planes)
            return;
        told_at_ = now;
        const std::string text = "Rendering plane " + std::to_string(plane + 2) + " of " +
                                 std::to_string(planes) + " of the sweep";
        post(std::exchange(told_, true) ? GST_PROGRESS_TYPE_CONTINUE : GST_PROGRESS_TYPE_START, text.c_str());
    }

private:
    void post(GstProgressType type, const char *text)
    {
        gst_element_post_message(element_,
                                 gst_message_new_progress(GST_OBJECT(element_), type, "render", text));
    }

    GstElement *element_;
    GstClockTime told_at_ = gst_util_get_timestamp();
    bool told_ = false;
};

} // namespace

static bool eos_is_due(GstLensSweepTestSrc *self)
{
    GST_OBJECT_LOCK(self);
    const bool wanted = self->state->eos_wanted;
    GST_OBJECT_UNLOCK(self);
    return wanted || self->state->stream->finished();
}

/* Throws std::exception with a user's text. */
static GstFlowReturn render(GstLensSweepTestSrc *self)
{
    TestStream &stream = *self->state->stream;
    const GstClockTime begin = gst_util_get_timestamp();
    if (const auto fault = dff::value_out_of_range(G_OBJECT(self)))
        throw std::invalid_argument(*fault);
    {
        RenderProgress progress(GST_ELEMENT(self));
        stream.render(rendering_token(self), std::ref(progress));
    }
    if (!stream.is_rendered())
        return eos_is_due(self) ? GST_FLOW_EOS : GST_FLOW_FLUSHING;
    GST_INFO_OBJECT(self, "rendered in %" GST_TIME_FORMAT, GST_TIME_ARGS(gst_util_get_timestamp() - begin));
    /* A live camera does not catch up on what it missed. */
    if (stream.is_live() && self->state->pacer.wait_until_playing())
        stream.postpone(gst_element_get_current_running_time(GST_ELEMENT(self)));
    return GST_FLOW_OK;
}

namespace {

/* What is told on one of the pads of the truth. */
struct Truth {
    const gchar *name;
    GstPad *GstLensSweepTestSrcState::*pad;
    GstCaps *(TestStream::*caps)() const;
    GstBuffer *(TestStream::*buffer)() const;
};

constexpr Truth truths[] = {
    {"depth", &GstLensSweepTestSrcState::depth_pad, &TestStream::depth_caps, &TestStream::depth},
    {"motion", &GstLensSweepTestSrcState::motion_pad, &TestStream::motion_caps, &TestStream::motion},
};

} // namespace

static void begin_truth(GstLensSweepTestSrc *self, const Truth &truth, GstPad *pad)
{
    begin_stream(GST_ELEMENT(self), pad, truth.name, group_of(self->src_pad));
    if (gst_pad_has_current_caps(self->src_pad)) {
        g_autoptr(GstCaps) caps = (self->state->stream.get()->*truth.caps)();
        change_caps(pad, caps);
    }
    begin_segment(pad);
}

/* Whoever does not take the truth any more does not stop the pictures. */
static GstFlowReturn push_truth(GstLensSweepTestSrc *self)
{
    for (const Truth &truth : truths) {
        g_autoptr(GstPad) pad = gst_lens_sweep_test_src_ref_pad(self, truth.pad);
        if (!pad)
            continue;
        begin_truth(self, truth, pad);
        const GstFlowReturn flow = gst_pad_push(pad, (self->state->stream.get()->*truth.buffer)());
        if (flow == GST_FLOW_NOT_NEGOTIATED || flow <= GST_FLOW_ERROR)
            return flow;
    }
    return GST_FLOW_OK;
}

GstPad *gst_lens_sweep_test_src_ref_pad(GstLensSweepTestSrc *self, GstPad *GstLensSweepTestSrcState::*which)
{
    GST_OBJECT_LOCK(self);
    GstPad *pad = self->state->*which;
    if (pad)
        gst_object_ref(pad);
    GST_OBJECT_UNLOCK(self);
    return pad;
}

static void take_changes(GstLensSweepTestSrc *self)
{
    GST_OBJECT_LOCK(self);
    if (self->state->settings_changed)
        self->state->stream->set_scene(self->state->settings.scene);
    self->state->settings_changed = false;
    GST_OBJECT_UNLOCK(self);
}

static GstFlowReturn produce(GstLensSweepTestSrc *self)
{
    TestStream &stream = *self->state->stream;
    LivePacer &pacer = self->state->pacer;
    begin_stream(GST_ELEMENT(self), self->src_pad, "src", gst_util_group_id_next());
    if (stream.is_live() && !pacer.wait_until_playing())
        return GST_FLOW_FLUSHING;
    if (stream.at_sweep_start())
        take_changes(self);

    GstFlowReturn flow = GST_FLOW_OK;
    if (gst_pad_check_reconfigure(self->src_pad) || !gst_pad_has_current_caps(self->src_pad))
        flow = negotiate(self);
    if (flow != GST_FLOW_OK)
        return flow;
    begin_segment(self->src_pad);
    if (eos_is_due(self))
        return GST_FLOW_EOS;
    if (!stream.is_rendered())
        flow = render(self);
    if (flow != GST_FLOW_OK)
        return flow;

    g_autoptr(GstBuffer) buffer = stream.frame();
    GST_LOG_OBJECT(self, "frame %" G_GUINT64_FORMAT " of %" GST_TIME_FORMAT, GST_BUFFER_OFFSET(buffer),
                   GST_TIME_ARGS(GST_BUFFER_PTS(buffer)));
    /* The picture leaves the camera at the end of its exposure. */
    const GstClockTime end = GST_BUFFER_PTS(buffer) + GST_BUFFER_DURATION(buffer);
    if (stream.is_live() && !pacer.wait_until(GST_ELEMENT(self), end))
        return GST_FLOW_FLUSHING;
    if (stream.at_sweep_start())
        flow = push_truth(self);
    stream.advance();
    return flow == GST_FLOW_OK
               ? gst_pad_push(self->src_pad, static_cast<GstBuffer *>(g_steal_pointer(&buffer)))
               : flow;
}

static GstFlowReturn produce_or_say_why_not(GstLensSweepTestSrc *self)
{
    try {
        return produce(self);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("The scene cannot be rendered: %s.", error.what()),
                          (nullptr));
        return GST_FLOW_ERROR;
    }
}

static void end_streams(GstLensSweepTestSrc *self)
{
    for (const Truth &truth : truths) {
        g_autoptr(GstPad) pad = gst_lens_sweep_test_src_ref_pad(self, truth.pad);
        if (!pad)
            continue;
        begin_truth(self, truth, pad);
        gst_pad_push_event(pad, gst_event_new_eos());
    }
    gst_pad_push_event(self->src_pad, gst_event_new_eos());
}

void gst_lens_sweep_test_src_loop(gpointer user_data)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(user_data);
    const GstFlowReturn flow = produce_or_say_why_not(self);
    const bool renegotiates = flow == GST_FLOW_NOT_NEGOTIATED && gst_pad_needs_reconfigure(self->src_pad);
    if (flow == GST_FLOW_OK || renegotiates)
        return;
    GST_DEBUG_OBJECT(self, "stopping: %s", gst_flow_get_name(flow));
    gst_pad_pause_task(self->src_pad);
    if (flow == GST_FLOW_FLUSHING)
        return;
    /* For GST_FLOW_ERROR whoever failed has said why. */
    if (flow == GST_FLOW_NOT_LINKED || flow == GST_FLOW_NOT_NEGOTIATED)
        GST_ELEMENT_FLOW_ERROR(self, flow);
    end_streams(self);
}
