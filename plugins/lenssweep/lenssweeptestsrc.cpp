/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-lenssweeptestsrc
 * @title: lenssweeptestsrc
 * @short_description: a simulated camera with a swept focus
 *
 * Renders a scene as a camera behind a liquid lens sees it while the focus is swept: thin-lens blur with
 * occlusion, noise of the sensor, breathing. Each buffer is one plane with its #GstFocusMeta; plane 0 is the
 * nearest. Pictures are a function of the properties alone, `seed` included.
 *
 * A scene that stands still is rendered once and replayed without a copy, so the buffers' memory is
 * read-only. With noise, the noise of four sweeps is rendered and repeats after them.
 *
 * The request pad `depth` gives the true depth once a sweep: GRAY16_LE in dioptres with #GstDepthMeta, 0
 * where a depth map has no value. Put a queue behind each pad.
 *
 * ## Example launch lines
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 ! videoconvert ! autovideosink
 * ]|
 * |[
 * gst-launch-1.0 lenssweeptestsrc name=rig num-buffers=60 noise=moderate ! queue ! fakesink \
 *     rig.depth ! queue ! fakesink
 * ]|
 */
#include "lenssweeptestsrc.h"

#include "live_pacer.h"
#include "stream_pad.h"
#include "test_settings.h"
#include "test_stream.h"

#include <exception>
#include <gst/video/video.h>
#include <memory>

GST_DEBUG_CATEGORY_STATIC(gst_lens_sweep_test_src_debug);
#define GST_CAT_DEFAULT gst_lens_sweep_test_src_debug

#define VIDEO_CAPS GST_VIDEO_CAPS_MAKE("{ I420, GRAY8, GRAY16_LE, NV12, RGB, BGR, RGBx, BGRx }")
#define DEPTH_CAPS GST_VIDEO_CAPS_MAKE("GRAY16_LE")

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(VIDEO_CAPS));
static GstStaticPadTemplate depth_template =
    GST_STATIC_PAD_TEMPLATE("depth", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(DEPTH_CAPS));

struct GstLensSweepTestSrcState {
    /* Guarded by the object lock. */
    TestSettings settings;
    bool settings_changed = false;
    bool eos_wanted = false;
    std::stop_source stop; /* of the rendering */
    GstPad *depth_pad = nullptr;

    LivePacer pacer; /* guards itself */

    /* Made in READY to PAUSED, then the streaming thread's alone until PAUSED to READY. */
    std::unique_ptr<TestStream> stream;
};

struct _GstLensSweepTestSrc {
    GstElement parent;
    GstPad *src_pad;
    GstLensSweepTestSrcState *state;
};

G_DEFINE_FINAL_TYPE(GstLensSweepTestSrc, gst_lens_sweep_test_src, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(lenssweeptestsrc, "lenssweeptestsrc", GST_RANK_NONE,
                                      GST_TYPE_LENS_SWEEP_TEST_SRC,
                                      GST_DEBUG_CATEGORY_INIT(gst_lens_sweep_test_src_debug,
                                                              "lenssweeptestsrc", 0,
                                                              "simulated camera with a swept focus"))

static GstFlowReturn negotiate(GstLensSweepTestSrc *self)
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
    if (!gst_video_info_from_caps(&info, chosen))
        return GST_FLOW_NOT_NEGOTIATED;
    g_autoptr(GstCaps) complete = gst_video_info_to_caps(&info);
    if (!change_caps(self->src_pad, complete))
        return GST_PAD_IS_FLUSHING(self->src_pad) ? GST_FLOW_FLUSHING : GST_FLOW_NOT_NEGOTIATED;
    stream.set_format(info);
    return GST_FLOW_OK;
}

/* A token that ends the rendering which begins now. */
static std::stop_token rendering_token(GstLensSweepTestSrc *self)
{
    GST_OBJECT_LOCK(self);
    std::stop_token token = self->state->stop.get_token();
    GST_OBJECT_UNLOCK(self);
    return token;
}

static GstFlowReturn render(GstLensSweepTestSrc *self)
{
    TestStream &stream = *self->state->stream;
    const GstClockTime begin = gst_util_get_timestamp();
    try {
        stream.render(rendering_token(self));
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("The scene cannot be rendered: %s.", error.what()),
                          (nullptr));
        return GST_FLOW_ERROR;
    }
    if (!stream.is_rendered())
        return GST_FLOW_FLUSHING;
    GST_INFO_OBJECT(self, "rendered in %" GST_TIME_FORMAT, GST_TIME_ARGS(gst_util_get_timestamp() - begin));
    /* A live camera does not catch up on what it missed. */
    if (stream.is_live() && self->state->pacer.wait_until_playing())
        stream.postpone(gst_element_get_current_running_time(GST_ELEMENT(self)));
    return GST_FLOW_OK;
}

static void begin_depth(GstLensSweepTestSrc *self, GstPad *pad)
{
    begin_stream(GST_ELEMENT(self), pad, "depth", group_of(self->src_pad));
    if (gst_pad_has_current_caps(self->src_pad)) {
        g_autoptr(GstCaps) caps = self->state->stream->depth_caps();
        change_caps(pad, caps);
    }
    begin_segment(pad);
}

/* Whoever does not take the depth any more does not stop the pictures. */
static GstFlowReturn push_depth(GstLensSweepTestSrc *self, GstPad *pad)
{
    begin_depth(self, pad);
    const GstFlowReturn flow = gst_pad_push(pad, self->state->stream->depth());
    return flow == GST_FLOW_NOT_NEGOTIATED || flow <= GST_FLOW_ERROR ? flow : GST_FLOW_OK;
}

static GstPad *ref_depth_pad(GstLensSweepTestSrc *self)
{
    GST_OBJECT_LOCK(self);
    GstPad *pad = self->state->depth_pad;
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

static bool eos_is_due(GstLensSweepTestSrc *self)
{
    GST_OBJECT_LOCK(self);
    const bool wanted = self->state->eos_wanted;
    GST_OBJECT_UNLOCK(self);
    return wanted || self->state->stream->finished();
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
    /* The picture leaves the camera at the end of its exposure. */
    const GstClockTime end = GST_BUFFER_PTS(buffer) + GST_BUFFER_DURATION(buffer);
    if (stream.is_live() && !pacer.wait_until(GST_ELEMENT(self), end))
        return GST_FLOW_FLUSHING;
    g_autoptr(GstPad) depth_pad = stream.at_sweep_start() ? ref_depth_pad(self) : nullptr;
    if (depth_pad)
        flow = push_depth(self, depth_pad);
    stream.advance();
    return flow == GST_FLOW_OK
               ? gst_pad_push(self->src_pad, static_cast<GstBuffer *>(g_steal_pointer(&buffer)))
               : flow;
}

static void end_streams(GstLensSweepTestSrc *self)
{
    g_autoptr(GstPad) depth_pad = ref_depth_pad(self);
    if (depth_pad) {
        begin_depth(self, depth_pad);
        gst_pad_push_event(depth_pad, gst_event_new_eos());
    }
    gst_pad_push_event(self->src_pad, gst_event_new_eos());
}

static void loop(gpointer user_data)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(user_data);
    const GstFlowReturn flow = produce(self);
    if (flow == GST_FLOW_OK)
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

static gboolean activate_mode(GstPad *pad, GstObject *parent, GstPadMode mode, gboolean active)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(parent);
    if (mode != GST_PAD_MODE_PUSH)
        return FALSE;
    self->state->pacer.set_flushing(!active);
    if (active)
        return TRUE;
    GST_OBJECT_LOCK(self);
    self->state->stop.request_stop();
    GST_OBJECT_UNLOCK(self);
    return gst_pad_stop_task(pad);
}

static gboolean query(GstPad *pad, GstObject *parent, GstQuery *query)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(parent);
    if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY)
        return gst_pad_query_default(pad, parent, query);
    TestStream *stream = self->state->stream.get();
    if (!stream)
        return FALSE;
    gst_query_set_latency(query, stream->is_live(), stream->is_live() ? stream->frame_duration() : 0,
                          GST_CLOCK_TIME_NONE);
    return TRUE;
}

static bool start(GstLensSweepTestSrc *self)
{
    GST_OBJECT_LOCK(self);
    const TestSettings settings = self->state->settings;
    self->state->settings_changed = false;
    self->state->eos_wanted = false;
    self->state->stop = std::stop_source();
    GST_OBJECT_UNLOCK(self);
    try {
        self->state->stream = std::make_unique<TestStream>(settings);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("The properties cannot be used: %s.", error.what()),
                          (nullptr));
        return false;
    }
    return true;
}

static GstStateChangeReturn change_state(GstElement *element, GstStateChange transition)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(element);
    if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && !start(self))
        return GST_STATE_CHANGE_FAILURE;
    if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING || transition == GST_STATE_CHANGE_PLAYING_TO_PAUSED)
        self->state->pacer.set_playing(transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING);

    const GstStateChangeReturn result =
        GST_ELEMENT_CLASS(gst_lens_sweep_test_src_parent_class)->change_state(element, transition);
    if (result == GST_STATE_CHANGE_FAILURE)
        return result;
    if (transition == GST_STATE_CHANGE_PAUSED_TO_READY)
        self->state->stream.reset();
    /* Not when the src pad is activated: the depth pad is activated after it. */
    if (transition == GST_STATE_CHANGE_READY_TO_PAUSED)
        gst_pad_start_task(self->src_pad, loop, self, nullptr);
    const bool paused =
        transition == GST_STATE_CHANGE_READY_TO_PAUSED || transition == GST_STATE_CHANGE_PLAYING_TO_PAUSED;
    return paused && self->state->stream->is_live() ? GST_STATE_CHANGE_NO_PREROLL : result;
}

static gboolean send_event(GstElement *element, GstEvent *event)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(element);
    if (GST_EVENT_TYPE(event) != GST_EVENT_EOS)
        return GST_ELEMENT_CLASS(gst_lens_sweep_test_src_parent_class)->send_event(element, event);
    gst_event_unref(event);
    GST_OBJECT_LOCK(self);
    self->state->eos_wanted = true;
    GST_OBJECT_UNLOCK(self);
    return TRUE;
}

static GstPad *request_new_pad(GstElement *element, GstPadTemplate *templ, const gchar *, const GstCaps *)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(element);
    g_autoptr(GstPad) existing = ref_depth_pad(self);
    if (existing) {
        GST_WARNING_OBJECT(self, "there is one depth pad only; put a tee behind it");
        return nullptr;
    }
    GstPad *pad = gst_pad_new_from_template(templ, "depth");
    gst_pad_set_query_function(pad, query);
    GST_OBJECT_LOCK(self);
    self->state->depth_pad = pad;
    GST_OBJECT_UNLOCK(self);
    gst_element_add_pad(element, pad);
    return pad;
}

static void release_pad(GstElement *element, GstPad *pad)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(element);
    GST_OBJECT_LOCK(self);
    self->state->depth_pad = nullptr;
    GST_OBJECT_UNLOCK(self);
    gst_pad_set_active(pad, FALSE);
    gst_element_remove_pad(element, pad);
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(object);
    GST_OBJECT_LOCK(self);
    const bool known = set_test_property(self->state->settings, id, value);
    self->state->settings_changed = true;
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(object);
    GST_OBJECT_LOCK(self);
    const bool known = get_test_property(self->state->settings, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_LENS_SWEEP_TEST_SRC(object)->state;
    G_OBJECT_CLASS(gst_lens_sweep_test_src_parent_class)->finalize(object);
}

static void gst_lens_sweep_test_src_init(GstLensSweepTestSrc *self)
{
    self->state = new GstLensSweepTestSrcState;
    self->src_pad = gst_pad_new_from_static_template(&src_template, "src");
    gst_pad_set_activatemode_function(self->src_pad, activate_mode);
    gst_pad_set_query_function(self->src_pad, query);
    gst_element_add_pad(GST_ELEMENT(self), self->src_pad);
    GST_OBJECT_FLAG_SET(self, GST_ELEMENT_FLAG_SOURCE);
}

static void gst_lens_sweep_test_src_class_init(GstLensSweepTestSrcClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_test_properties(object_class);

    element_class->change_state = change_state;
    element_class->send_event = send_event;
    element_class->request_new_pad = request_new_pad;
    element_class->release_pad = release_pad;
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_add_static_pad_template(element_class, &depth_template);
    gst_element_class_set_static_metadata(element_class, "Focus sweep test source", "Source/Video",
                                          "Renders a scene as a camera with a swept focus sees it",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(GST_TYPE_LENS_SWEEP_TEST_SCENE, static_cast<GstPluginAPIFlags>(0));
}
