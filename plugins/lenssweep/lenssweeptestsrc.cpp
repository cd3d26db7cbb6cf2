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
 * A scene that stands still is rendered once and, without noise, replayed without a copy, so the buffers'
 * memory is read-only. Noise never repeats. A rendering that takes longer than a second posts progress
 * messages (`render`).
 *
 * The request pad `depth` gives the true depth once a sweep: GRAY16_LE in dioptres with #GstDepthMeta, 0
 * where a depth map has no value. What moves is seen where it is in the middle of the sweep, (planes - 1) / 2
 * planes after the first one, which lies between two planes where their number is even. A lens that breathes
 * has a magnification of 1 at plane planes / 2, onto which focalstackalign aligns. Put a queue behind each
 * pad.
 *
 * The request pad `motion` gives the true motion of what each pixel shows at the same time: RGBA64_LE, R and
 * G are 32768 + 64 times the pixels that it moves to the right and down from plane to plane (as the KITTI
 * data set has flow), B and A are 65535. The whole scene moves with `pan` and `shake`, `objects` fly before
 * it with `motion`; `frozen=true` shows the same sweeps as if each had been taken in no time.
 *
 * scene=board shows a chessboard to calibrate by, in a pose that is known: see dff-calibrate.
 *
 * ## Example launch lines
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 ! videoconvert ! autovideosink
 * ]|
 * |[
 * gst-launch-1.0 lenssweeptestsrc name=rig num-buffers=60 noise=moderate ! queue ! fakesink \
 *     rig.depth ! queue ! fakesink
 * ]|
 * |[
 * gst-launch-1.0 lenssweeptestsrc name=rig num-buffers=60 motion=4 objects=ball+crossing pan=1 ! queue ! \
 *     fakesink  rig.motion ! queue ! fakesink
 * ]|
 */
#include "lenssweeptestsrc.h"

#include "common/checked_properties.h"
#include "lenssweeptestsrc_private.h"

#include <gst/video/video.h>
#include <memory>
#include <stdexcept>
#include <utility>

GST_DEBUG_CATEGORY(gst_lens_sweep_test_src_debug);

#define VIDEO_CAPS GST_VIDEO_CAPS_MAKE("{ I420, GRAY8, GRAY16_LE, NV12, RGB, BGR, RGBx, BGRx, RGBA64_LE }")
#define DEPTH_CAPS GST_VIDEO_CAPS_MAKE("GRAY16_LE")
#define MOTION_CAPS GST_VIDEO_CAPS_MAKE("RGBA64_LE")

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(VIDEO_CAPS));
static GstStaticPadTemplate depth_template =
    GST_STATIC_PAD_TEMPLATE("depth", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(DEPTH_CAPS));
static GstStaticPadTemplate motion_template =
    GST_STATIC_PAD_TEMPLATE("motion", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(MOTION_CAPS));

G_DEFINE_FINAL_TYPE(GstLensSweepTestSrc, gst_lens_sweep_test_src, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(lenssweeptestsrc, "lenssweeptestsrc", GST_RANK_NONE,
                                      GST_TYPE_LENS_SWEEP_TEST_SRC,
                                      GST_DEBUG_CATEGORY_INIT(gst_lens_sweep_test_src_debug,
                                                              "lenssweeptestsrc", 0,
                                                              "simulated camera with a swept focus"))

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

/* Time cannot be turned back before a camera. The default would say that it was, and leave who asked waiting
 * for a flush. */
static gboolean source_event(GstPad *pad, GstObject *parent, GstEvent *event)
{
    if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK)
        return gst_pad_event_default(pad, parent, event);
    gst_event_unref(event);
    return FALSE;
}

static gboolean answer_seeking(GstQuery *query)
{
    GstFormat format = GST_FORMAT_UNDEFINED;
    gst_query_parse_seeking(query, &format, nullptr, nullptr, nullptr);
    gst_query_set_seeking(query, format, FALSE, 0, -1);
    return TRUE;
}

static gboolean answer_latency(GstLensSweepTestSrc *self, GstQuery *query)
{
    GST_OBJECT_LOCK(self);
    const TestStream *stream = self->state->stream.get();
    const bool known = stream != nullptr;
    const bool live = known && stream->is_live();
    const GstClockTime latency = live ? stream->frame_duration() : 0;
    GST_OBJECT_UNLOCK(self);
    if (known)
        gst_query_set_latency(query, live, latency, GST_CLOCK_TIME_NONE);
    return known;
}

static gboolean source_query(GstPad *pad, GstObject *parent, GstQuery *query)
{
    switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_LATENCY:
        return answer_latency(GST_LENS_SWEEP_TEST_SRC(parent), query);
    case GST_QUERY_SEEKING:
        return answer_seeking(query);
    default:
        return gst_pad_query_default(pad, parent, query);
    }
}

static void put_stream(GstLensSweepTestSrc *self, std::unique_ptr<TestStream> stream)
{
    GST_OBJECT_LOCK(self);
    self->state->stream.swap(stream);
    GST_OBJECT_UNLOCK(self);
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
        if (const auto fault = dff::value_out_of_range(G_OBJECT(self)))
            throw std::invalid_argument(*fault);
        put_stream(self, std::make_unique<TestStream>(settings));
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
        put_stream(self, nullptr);
    /* Not when the src pad is activated: the depth pad is activated after it. */
    if (transition == GST_STATE_CHANGE_READY_TO_PAUSED)
        gst_pad_start_task(self->src_pad, gst_lens_sweep_test_src_loop, self, nullptr);
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
    self->state->stop.request_stop(); /* nobody waits for the rest */
    GST_OBJECT_UNLOCK(self);
    return TRUE;
}

static GstPad *request_new_pad(GstElement *element, GstPadTemplate *templ, const gchar *, const GstCaps *)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(element);
    const gchar *name = GST_PAD_TEMPLATE_NAME_TEMPLATE(templ);
    GstPad *GstLensSweepTestSrcState::*which = g_str_equal(name, "motion")
                                                   ? &GstLensSweepTestSrcState::motion_pad
                                                   : &GstLensSweepTestSrcState::depth_pad;
    g_autoptr(GstPad) existing = gst_lens_sweep_test_src_ref_pad(self, which);
    if (existing) {
        GST_WARNING_OBJECT(self, "there is one %s pad only; put a tee behind it", name);
        return nullptr;
    }
    GstPad *pad = gst_pad_new_from_template(templ, name);
    gst_pad_set_event_function(pad, source_event);
    gst_pad_set_query_function(pad, source_query);
    GST_OBJECT_LOCK(self);
    self->state->*which = pad;
    GST_OBJECT_UNLOCK(self);
    gst_element_add_pad(element, pad);
    return pad;
}

static void release_pad(GstElement *element, GstPad *pad)
{
    auto *self = GST_LENS_SWEEP_TEST_SRC(element);
    GST_OBJECT_LOCK(self);
    GstPad *&known = pad == self->state->motion_pad ? self->state->motion_pad : self->state->depth_pad;
    known = nullptr;
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
    gst_pad_set_event_function(self->src_pad, source_event);
    gst_pad_set_query_function(self->src_pad, source_query);
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
    gst_element_class_add_static_pad_template(element_class, &motion_template);
    gst_element_class_set_static_metadata(element_class, "Focus sweep test source", "Source/Video",
                                          "Renders a scene as a camera with a swept focus sees it",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(GST_TYPE_LENS_SWEEP_TEST_SCENE, static_cast<GstPluginAPIFlags>(0));
    gst_type_mark_as_plugin_api(GST_TYPE_LENS_SWEEP_TEST_OBJECTS, static_cast<GstPluginAPIFlags>(0));
}
