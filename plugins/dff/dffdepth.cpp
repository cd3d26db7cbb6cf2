/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-dffdepth
 * @title: dffdepth
 * @short_description: depth from focal stacks
 *
 * Computes a dense depth map from each focal stack: the depth from focus of Oliva-García et al., Applied
 * Sciences 2022, 12, 3141, on any OpenCL device. Exactly one depth frame leaves for each stack; where nothing
 * can be told it is all 0 ("no value") and has the flags GAP and CORRUPTED.
 *
 * The request pads `sparse` (depth before it is filled, 0 = unknown), `confidence` (GRAY8) and `motion`
 * (GRAY8, 255 = moved during the sweep) cost nothing while they are not linked. Put a queue on every branch.
 *
 * The request pad `uncertainty` (GRAY16_LE) gives one standard deviation of each pixel of the depth map, in
 * its scale: multiplied by the scale of its GstDepthMeta (without the offset) it is in the depth's unit. It
 * grows with noise, lack of texture, beside depth edges, and is large where depth is filled and not seen;
 * about 68 % of pixels lie within one of them and 95 % within two. It is of one stack, whatever `steady`
 * makes of it, and knows nothing of a lens that is not where its calibration says. 0 where there is no depth.
 * method=paper does not tell it.
 *
 * A lens that does not move gives a full depth map all the same. Its confidence is next to nothing then, and
 * a warning says once that no plane is sharper than the others.
 *
 * Where the picture stands still, depth of live sources is the mean of up to 16 stacks, so that it does not
 * flicker (`steady`); what moves has the depth of its last stack alone.
 *
 * Hairs and nets are out of focus in the plane of what lies behind them, which shows through: both are sharp
 * in some plane, and that of which there is more to see has the depth. `prefer=near` (and method=volume)
 * gives it to the thin thing, `prefer=far` to what is behind.
 *
 * The OpenCL device is shared with the neighbours, or given by the application: see
 * gst_context_new_dff_device(). While a first stack takes over a second, as it does when kernels have to be
 * compiled, progress messages with the code "kernels" say so. A live pipeline's latency does not count that.
 *
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 ! focalstackmux ! dffdepth ! videoconvert ! fakesink
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 near=3 far=0.5 ! focalstackmux ! \
 *     dffdepth name=d unit=millimetre \
 *     d.src ! queue ! videoconvert ! pngenc ! filesink location=millimetres.png \
 *     d.uncertainty ! queue ! videoconvert ! pngenc ! filesink location=give-or-take.png
 * ]|
 */
#include "dffdepth.h"

#include "dffdepth_private.h"
#include "gstcl/engine_caps.h"
#include "gstcl/engine_message.h"

#include <gst/dff/dff.h>
#include <memory>

GST_DEBUG_CATEGORY(dff_depth_debug);

namespace {

constexpr guint property_stats = dff::depth_properties_end;

} // namespace

G_DEFINE_FINAL_TYPE(GstDffDepth, gst_dff_depth, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(dffdepth, "dffdepth", GST_RANK_NONE, GST_TYPE_DFF_DEPTH)

#define MAP_CAPS(format)                                                                                     \
    "video/x-raw, format = (string) " format ", " ENGINE_SIZES ", framerate = (fraction) [ 0, max ]"

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(ENGINE_STACK_CAPS));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(MAP_CAPS("GRAY16_LE")));
static GstStaticPadTemplate sparse_template =
    GST_STATIC_PAD_TEMPLATE("sparse", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(MAP_CAPS("GRAY16_LE")));
static GstStaticPadTemplate confidence_template =
    GST_STATIC_PAD_TEMPLATE("confidence", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(MAP_CAPS("GRAY8")));
static GstStaticPadTemplate motion_template =
    GST_STATIC_PAD_TEMPLATE("motion", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(MAP_CAPS("GRAY8")));

static GstStaticPadTemplate uncertainty_template = GST_STATIC_PAD_TEMPLATE(
    "uncertainty", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(MAP_CAPS("GRAY16_LE")));

static dff::DepthSettings settings_of(GstDffDepthState &state)
{
    const std::lock_guard lock(state.mutex);
    return state.settings;
}

static bool is_live(GstDffDepth *self)
{
    gboolean live = FALSE;
    GstQuery *query = gst_query_new_latency();
    if (gst_pad_peer_query(self->sink, query))
        gst_query_parse_latency(query, &live, nullptr, nullptr);
    gst_query_unref(query);
    return live;
}

static gboolean set_caps(GstDffDepth *self, const GstCaps *caps)
{
    GstDffDepthState &state = *self->state;
    GstFocalStackInfo info;

    state.has_caps = false;
    if (!gst_focal_stack_info_from_caps(&info, caps)) {
        GST_ELEMENT_ERROR(self, CORE, NEGOTIATION,
                          ("These are not the caps of a focal stack: %" GST_PTR_FORMAT, caps), (nullptr));
        return FALSE;
    }
    if (const auto problem = dff::wrong_size(info.frame)) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s", problem->c_str()), (nullptr));
        return FALSE;
    }
    GST_INFO_OBJECT(self, "stacks are %" GST_PTR_FORMAT, caps);
    try {
        if (const auto settings = gst_dff_depth_changed_settings(state))
            state.depth.set_settings(*settings);
        state.depth.set_stack(info);
        state.depth.set_live(is_live(self));
        state.has_caps = true;
        return TRUE;
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(self), error);
        return FALSE;
    }
}

/* A stream of bytes (a file) becomes a stream in time. */
static void set_segment(GstDffDepthState &state, GstEvent *event)
{
    const GstSegment *segment = nullptr;
    gst_event_parse_segment(event, &segment);
    state.segment = {state.clock.begin(*segment), gst_event_get_seqnum(event)};
}

static gboolean gst_dff_depth_sink_event(GstPad *pad, GstObject *parent, GstEvent *event)
{
    GstDffDepth *self = GST_DFF_DEPTH(parent);
    GstDffDepthState &state = *self->state;

    switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
        state.outputs.restart();
        gst_event_unref(event); /* each output opens with its own */
        return TRUE;
    case GST_EVENT_CAPS: {
        GstCaps *caps = nullptr;
        gst_event_parse_caps(event, &caps);
        const gboolean accepted = set_caps(self, caps);
        gst_event_unref(event); /* each output has its own, sent before its next picture */
        return accepted;
    }
    case GST_EVENT_SEGMENT:
        set_segment(state, event);
        gst_event_unref(event);
        return TRUE;
    case GST_EVENT_GAP:
        state.outputs.pass_gap(event, state.segment);
        gst_event_unref(event);
        return TRUE;
    case GST_EVENT_FLUSH_STOP:
        state.depth.forget();
        state.outputs.restart();
        break;
    case GST_EVENT_EOS:
        state.outputs.end(state.segment);
        break;
    default:
        if (GST_EVENT_IS_SERIALIZED(event))
            state.outputs.open();
        break;
    }
    return gst_pad_event_default(pad, parent, event);
}

static gboolean gst_dff_depth_query(GstPad *pad, GstObject *parent, GstQuery *query)
{
    GstDffDepthState &state = *GST_DFF_DEPTH(parent)->state;
    gboolean live = FALSE;
    GstClockTime least = 0, most = GST_CLOCK_TIME_NONE;

    if (state.device.answer(query))
        return TRUE;
    if (GST_PAD_IS_SINK(pad) || GST_QUERY_TYPE(query) != GST_QUERY_LATENCY)
        return gst_pad_query_default(pad, parent, query);
    if (!gst_pad_peer_query(GST_DFF_DEPTH(parent)->sink, query))
        return FALSE;
    gst_query_parse_latency(query, &live, &least, &most);
    const std::lock_guard lock(state.mutex);
    const GstClockTime own = state.latency.get();
    gst_query_set_latency(query, live, least + own, GST_CLOCK_TIME_IS_VALID(most) ? most + own : most);
    return TRUE;
}

static void add_output(GstDffDepth *self, GstPad *pad, GstVideoFormat format)
{
    gst_pad_set_query_function(pad, gst_dff_depth_query);
    gst_pad_use_fixed_caps(pad);
    self->state->outputs.add(GST_ELEMENT(self), pad, format);
    gst_element_add_pad(GST_ELEMENT(self), pad);
}

static GstPad *gst_dff_depth_request_new_pad(GstElement *element, GstPadTemplate *templ, const gchar *,
                                             const GstCaps *)
{
    g_autoptr(GstPad) taken = gst_element_get_static_pad(element, templ->name_template);
    if (taken) {
        GST_WARNING_OBJECT(element, "The pad %s is in use already", templ->name_template);
        return nullptr;
    }
    GstPad *pad = gst_pad_new_from_template(templ, templ->name_template);
    gst_pad_set_active(pad, TRUE);
    add_output(GST_DFF_DEPTH(element), pad,
               g_str_equal(templ->name_template, "sparse") || g_str_equal(templ->name_template, "uncertainty")
                   ? GST_VIDEO_FORMAT_GRAY16_LE
                   : GST_VIDEO_FORMAT_GRAY8);
    return pad;
}

static void gst_dff_depth_release_pad(GstElement *element, GstPad *pad)
{
    GST_DFF_DEPTH(element)->state->outputs.remove(pad);
    gst_pad_set_active(pad, FALSE);
    gst_element_remove_pad(element, pad);
}

static bool open_device(GstDffDepth *self)
{
    GstDffDepthState &state = *self->state;
    try {
        std::shared_ptr<dff::Device> device = state.device.open(settings_of(state).device);
        GST_INFO_OBJECT(self, "computing on %s", device->name().c_str());
        state.depth.start(std::move(device));
        return true;
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(self), error);
        return false;
    }
}

static bool load_calibration(GstDffDepth *self)
{
    GstDffDepthState &state = *self->state;
    const std::string file = settings_of(state).calibration;
    try {
        if (file.empty())
            state.depth.set_calibration(std::nullopt, std::nullopt);
        else
            state.depth.set_calibration(dff::read_camera_calibration(file),
                                        dff::read_focus_calibration(file));
        return true;
    } catch (const std::runtime_error &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
        return false;
    }
}

static GstStateChangeReturn gst_dff_depth_change_state(GstElement *element, GstStateChange transition)
{
    GstDffDepth *self = GST_DFF_DEPTH(element);
    GstDffDepthState &state = *self->state;

    if (transition == GST_STATE_CHANGE_NULL_TO_READY && !open_device(self))
        return GST_STATE_CHANGE_FAILURE;
    if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && !load_calibration(self))
        return GST_STATE_CHANGE_FAILURE;

    const GstStateChangeReturn result =
        GST_ELEMENT_CLASS(gst_dff_depth_parent_class)->change_state(element, transition);

    if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
        state.has_caps = false;
        state.next_stack = 0;
        state.clock = {};
        state.last_warning.clear();
        state.peaks = {};
        state.told_of_no_peaks = false;
        state.told_of_no_uncertainty = false;
        state.outputs.restart();
        const std::lock_guard lock(state.mutex);
        state.statistics = {};
        state.latency.reset();
    }
    if (transition == GST_STATE_CHANGE_READY_TO_NULL) {
        state.depth.stop();
        state.device.close();
    }
    return result;
}

static void gst_dff_depth_set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    GstDffDepthState &state = *GST_DFF_DEPTH(object)->state;
    const std::lock_guard lock(state.mutex);
    if (!dff::set_depth_property(state.settings, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    state.settings_changed = true;
}

static void gst_dff_depth_get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    GstDffDepthState &state = *GST_DFF_DEPTH(object)->state;
    const std::lock_guard lock(state.mutex);
    if (id == property_stats)
        g_value_take_boxed(value, state.statistics.to_structure());
    else if (!dff::get_depth_property(state.settings, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void gst_dff_depth_finalize(GObject *object)
{
    delete GST_DFF_DEPTH(object)->state;
    G_OBJECT_CLASS(gst_dff_depth_parent_class)->finalize(object);
}

static void gst_dff_depth_init(GstDffDepth *self)
{
    self->state = new GstDffDepthState(GST_ELEMENT(self));
    self->sink = gst_pad_new_from_static_template(&sink_template, "sink");
    gst_pad_set_chain_function(self->sink, gst_dff_depth_chain);
    gst_pad_set_event_function(self->sink, gst_dff_depth_sink_event);
    gst_pad_set_query_function(self->sink, gst_dff_depth_query);
    gst_element_add_pad(GST_ELEMENT(self), self->sink);
    add_output(self, gst_pad_new_from_static_template(&src_template, "src"), GST_VIDEO_FORMAT_GRAY16_LE);
}

static void gst_dff_depth_class_init(GstDffDepthClass *klass)
{
    GObjectClass *object_class = G_OBJECT_CLASS(klass);
    GstElementClass *element_class = GST_ELEMENT_CLASS(klass);

    GST_DEBUG_CATEGORY_INIT(dff_depth_debug, "dffdepth", 0, "depth from focal stacks");
    object_class->set_property = gst_dff_depth_set_property;
    object_class->get_property = gst_dff_depth_get_property;
    object_class->finalize = gst_dff_depth_finalize;
    element_class->change_state = gst_dff_depth_change_state;
    element_class->request_new_pad = gst_dff_depth_request_new_pad;
    element_class->release_pad = gst_dff_depth_release_pad;

    dff::install_depth_properties(object_class);
    dff::DepthStatistics::install_property(object_class, property_stats);

    for (GstStaticPadTemplate *pad_template : {&sink_template, &src_template, &sparse_template,
                                               &confidence_template, &motion_template, &uncertainty_template})
        gst_element_class_add_static_pad_template(element_class, pad_template);
    gst_element_class_set_static_metadata(element_class, "Depth from focus", "Filter/Analyzer/Video",
                                          "Computes a depth map from each focal stack",
                                          "the gst-plugins-dff authors");
}
