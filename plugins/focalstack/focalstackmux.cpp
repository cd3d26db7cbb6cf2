/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-focalstackmux
 *
 * Puts the frames of a focus sweep together to focal stacks, one buffer a sweep, in which plane 0 is the
 * nearest.
 *
 * On the pad `sink` the frames come in the order in which they were taken, each with a #GstFocusMeta that
 * says which plane of which sweep it is (lenssweepsrc, lenssweeptag and lenssweeptestsrc write it). On the
 * pads `sink_0`, `sink_1`, ... each source gives the frames of one plane; there no meta is needed, and frames
 * belong together by their metas where they have them, otherwise by their running time. The pictures of one
 * sweep must have the same caps; new caps of all sources may begin at any sweep. A flush of one of these pads
 * leaves the others running. The stream ends when no pad is linked any more whose own stream did not end.
 *
 * A sweep is over when all of its planes are there, or when a third frame of later sweeps has come (two may
 * overtake). What then is missing costs this one stack, or is filled in: see #focalstackmux:on-missing. Every
 * loss is counted in #focalstackmux:stats and posted as a QoS message. A source that numbers its sweeps anew
 * is followed after one sweep or 16 frames. A sweep of which not one frame came is never made up. Where no
 * stack can be made of the frames of 16 sweeps a warning says why. A plane that is filled in before it ever
 * came has the power that makes the steps between planes even.
 *
 * A stack's time is that of its first exposure's start, its duration reaches to the end of the last exposure.
 *
 * With window=rolling every frame makes a stack of the last planes, once all of them were there; such a stack
 * costs planes + 1 copies of a frame.
 *
 * ## Example pipeline
 * |[
 * gst-launch-1.0 videotestsrc num-buffers=4 ! m.sink_0  videotestsrc num-buffers=4 pattern=ball ! m.sink_1 \
 *     focalstackmux name=m ! fakesink silent=false -v
 * ]| makes four stacks of two planes.
 */
#include "focalstack/focalstackmux.h"

#include "common/checked_properties.h"
#include "focalstack/focalstackmux_properties.h"
#include "focalstack/mux_core.h"
#include "focalstack/stack_caps.h"

#include <cstdio>
#include <mutex>

GST_DEBUG_CATEGORY(focalstackmux_debug);
#define GST_CAT_DEFAULT focalstackmux_debug

namespace {

struct FocalStackMuxState {
    FocalStackMuxState(GstElement *element, GstPad *source) : core(element, source) {}

    dff::MuxCore core;
    std::mutex seek;           /* held during a seek, before all others */
    dff::MuxSettings settings; /* guarded by the object's lock */
};

constexpr guint property_stats = dff::mux_properties_end;

GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(FOCAL_STACK_FRAME_CAPS));
GstStaticPadTemplate plane_template = GST_STATIC_PAD_TEMPLATE("sink_%u", GST_PAD_SINK, GST_PAD_REQUEST,
                                                              GST_STATIC_CAPS(FOCAL_STACK_FRAME_CAPS));
GstStaticPadTemplate source_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_MAKE));

} // namespace

struct _GstFocalStackMux {
    GstElement parent;
    GstPad *sink;
    GstPad *source;
    FocalStackMuxState *state;
};

G_DEFINE_FINAL_TYPE(GstFocalStackMux, gst_focal_stack_mux, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(focalstackmux, "focalstackmux", GST_RANK_NONE, GST_TYPE_FOCAL_STACK_MUX)

namespace {

dff::MuxInput &input_of(GstPad *pad)
{
    return *static_cast<dff::MuxInput *>(gst_pad_get_element_private(pad));
}

GstFlowReturn chain(GstPad *pad, GstObject *parent, GstBuffer *buffer)
{
    const dff::BufferPtr frame(buffer);
    return GST_FOCAL_STACK_MUX(parent)->state->core.take(input_of(pad), frame.get());
}

/* Words for what a CAPS query lets pass for their sake. */
bool accepts_size(GstFocalStackMux *self, GstPad *pad, GstCaps *caps)
{
    g_autoptr(GstCaps) usable = dff::caps_through(pad, self->source, dff::frame_caps_from_stack_caps);
    if (gst_caps_can_intersect(usable, caps))
        return true;
    const std::string limits = dff::describe_sizes(usable);
    GST_ELEMENT_ERROR(self, STREAM, FORMAT,
                      ("Pictures of %s pixels cannot become stacks: %s can.",
                       dff::describe_sizes(caps).c_str(), limits.c_str()),
                      ("Put videoscale or videocrop before this element."));
    return false;
}

gboolean take_caps(GstFocalStackMux *self, dff::MuxInput &input, GstEvent *event)
{
    GstCaps *caps = nullptr;
    gst_event_parse_caps(event, &caps);
    const bool taken = accepts_size(self, input.pad, caps) && self->state->core.set_caps(input, caps);
    gst_event_unref(event);
    return taken;
}

gboolean take_segment(GstFocalStackMux *self, dff::MuxInput &input, GstEvent *event)
{
    const GstSegment *segment = nullptr;
    gst_event_parse_segment(event, &segment);
    self->state->core.set_segment(input, *segment, gst_event_get_seqnum(event));
    gst_event_unref(event);
    return TRUE;
}

gboolean sink_event(GstPad *pad, GstObject *parent, GstEvent *event)
{
    GstFocalStackMux *self = GST_FOCAL_STACK_MUX(parent);
    dff::MuxCore &core = self->state->core;
    dff::MuxInput &input = input_of(pad);

    switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
        core.begin(input, event);
        return TRUE;
    case GST_EVENT_CAPS:
        return take_caps(self, input, event);
    case GST_EVENT_SEGMENT:
        return take_segment(self, input, event);
    case GST_EVENT_GAP:
        return core.pass_gap(input, event);
    case GST_EVENT_EOS:
        core.end(input, event);
        return TRUE;
    case GST_EVENT_FLUSH_START:
        core.begin_flush(input, event);
        return TRUE;
    case GST_EVENT_FLUSH_STOP:
        core.end_flush(input, event);
        return TRUE;
    default:
        return gst_pad_event_default(pad, parent, event);
    }
}

/* Each input's source flushes in turn, downstream sees one flush. */
gboolean source_event(GstPad *pad, GstObject *parent, GstEvent *event)
{
    FocalStackMuxState &state = *GST_FOCAL_STACK_MUX(parent)->state;
    GstSeekFlags flags = GST_SEEK_FLAG_NONE;
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK)
        gst_event_parse_seek(event, nullptr, nullptr, &flags, nullptr, nullptr, nullptr, nullptr);
    if (!(flags & GST_SEEK_FLAG_FLUSH) || !state.core.has_planes_apart())
        return gst_pad_event_default(pad, parent, event);

    const std::lock_guard lock(state.seek);
    const guint32 seqnum = gst_event_get_seqnum(event);
    state.core.begin_seek();
    const gboolean sought = gst_pad_event_default(pad, parent, event);
    state.core.end_seek(seqnum);
    return sought;
}

gboolean sink_query(GstPad *pad, GstObject *parent, GstQuery *query)
{
    switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_CAPS:
        dff::answer_caps_query(query, pad, GST_FOCAL_STACK_MUX(parent)->source,
                               dff::frame_caps_from_stack_caps, dff::Sizes::AnyInNeed);
        return TRUE;
    case GST_QUERY_ALLOCATION:
        /* Every frame is copied: any layout will do, and downstream's buffers are of no use. */
        gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
        return TRUE;
    default:
        return gst_pad_query_default(pad, parent, query);
    }
}

gboolean answer_latency(GstFocalStackMux *self, GstQuery *query)
{
    gboolean live = FALSE;
    GstClockTime least = 0;
    GstClockTime most = GST_CLOCK_TIME_NONE;
    if (!gst_pad_query_default(self->source, GST_OBJECT(self), query))
        return FALSE;
    const GstClockTime own = self->state->core.latency();
    gst_query_parse_latency(query, &live, &least, &most);
    gst_query_set_latency(query, live, least + own, GST_CLOCK_TIME_IS_VALID(most) ? most + own : most);
    return TRUE;
}

gboolean source_query(GstPad *pad, GstObject *parent, GstQuery *query)
{
    GstFocalStackMux *self = GST_FOCAL_STACK_MUX(parent);
    switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_LATENCY:
        return answer_latency(self, query);
    default:
        return gst_pad_query_default(pad, parent, query);
    }
}

/* In a thread of its own: the application's must not be blocked by what is downstream. */
void end_if_due(GstElement *element)
{
    const auto end = [](GstElement *mux, gpointer) { GST_FOCAL_STACK_MUX(mux)->state->core.end_if_due(); };
    if (GST_FOCAL_STACK_MUX(element)->state->core.end_is_due())
        gst_element_call_async(element, end, nullptr, nullptr);
}

void on_linked(GstPad *pad, GstPad *, gpointer element)
{
    GST_FOCAL_STACK_MUX(element)->state->core.open_input(input_of(pad));
}

void on_unlinked(GstPad *pad, GstPad *, gpointer element)
{
    GST_DEBUG_OBJECT(pad, "unlinked");
    GST_FOCAL_STACK_MUX(element)->state->core.close_input(input_of(pad));
    end_if_due(GST_ELEMENT(element));
}

void add_input(GstFocalStackMux *self, GstPad *pad, std::optional<unsigned> plane)
{
    gst_pad_set_chain_function(pad, chain);
    gst_pad_set_event_function(pad, sink_event);
    gst_pad_set_query_function(pad, sink_query);
    gst_pad_set_element_private(pad, &self->state->core.add_input(pad, plane));
    if (plane) {
        g_signal_connect(pad, "linked", G_CALLBACK(on_linked), self);
        g_signal_connect(pad, "unlinked", G_CALLBACK(on_unlinked), self);
    }
    gst_element_add_pad(GST_ELEMENT(self), pad);
}

/* The plane of the pad that is asked for; without a name, the nearest one that has no pad. */
unsigned requested_plane(GstElement *element, const gchar *name)
{
    unsigned plane = 0;
    if (name)
        return std::sscanf(name, "sink_%u", &plane) == 1 ? plane : dff::longest_stack;
    for (; plane < dff::longest_stack; plane++) {
        g_autofree gchar *free_name = g_strdup_printf("sink_%u", plane);
        g_autoptr(GstPad) taken = gst_element_get_static_pad(element, free_name);
        if (!taken)
            break;
    }
    return plane;
}

GstPad *request_new_pad(GstElement *element, GstPadTemplate *templ, const gchar *name, const GstCaps *)
{
    const unsigned plane = requested_plane(element, name);
    if (plane >= dff::longest_stack) {
        GST_ERROR_OBJECT(element, "the pads are sink_0 to sink_63: a stack has 64 planes at most");
        return nullptr;
    }

    g_autofree gchar *pad_name = g_strdup_printf("sink_%u", plane);
    g_autoptr(GstPad) taken = gst_element_get_static_pad(element, pad_name);
    if (taken) {
        GST_ERROR_OBJECT(element, "there is a pad %s already", pad_name);
        return nullptr;
    }
    GstPad *pad = gst_pad_new_from_template(templ, pad_name);
    add_input(GST_FOCAL_STACK_MUX(element), pad, plane);
    return pad;
}

/* Without a parent the pad lets nobody in any more; whoever is in holds its stream lock. */
void forget_pad(GstElement *element, gpointer pad)
{
    dff::MuxCore &core = GST_FOCAL_STACK_MUX(element)->state->core;
    GST_PAD_STREAM_LOCK(pad);
    core.remove_input(GST_PAD(pad));
    GST_PAD_STREAM_UNLOCK(pad);
    core.end_if_due();
}

/* The pad's thread may be pushing a stack: where it runs, another one waits for it, not the application's. */
void release_pad(GstElement *element, GstPad *pad)
{
    dff::MuxCore &core = GST_FOCAL_STACK_MUX(element)->state->core;
    const bool running = core.is_running();
    g_signal_handlers_disconnect_by_data(pad, element);
    core.release_input(input_of(pad));
    if (!running)
        gst_pad_set_active(pad, FALSE);
    gpointer kept = gst_object_ref(pad);
    gst_element_remove_pad(element, pad);
    if (running)
        gst_element_call_async(element, forget_pad, kept, gst_object_unref);
    else {
        forget_pad(element, kept);
        gst_object_unref(kept);
    }
}

bool start(GstFocalStackMux *self)
{
    if (const auto fault = dff::value_out_of_range(G_OBJECT(self))) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("The properties cannot be used: %s.", fault->c_str()),
                          (nullptr));
        return false;
    }
    GST_OBJECT_LOCK(self);
    const dff::MuxSettings settings = self->state->settings;
    GST_OBJECT_UNLOCK(self);
    return self->state->core.start(settings);
}

GstStateChangeReturn change_state(GstElement *element, GstStateChange transition)
{
    GstFocalStackMux *self = GST_FOCAL_STACK_MUX(element);
    dff::MuxCore &core = self->state->core;

    if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && !start(self))
        return GST_STATE_CHANGE_FAILURE;
    if (transition == GST_STATE_CHANGE_PAUSED_TO_READY)
        core.unblock();
    const GstStateChangeReturn changed =
        GST_ELEMENT_CLASS(gst_focal_stack_mux_parent_class)->change_state(element, transition);
    if (transition == GST_STATE_CHANGE_PAUSED_TO_READY)
        core.stop();
    return changed;
}

GstStructure *create_stats(const dff::MuxStatistics &counts)
{
    return gst_structure_new("focal-stack-mux-stats", "frames", G_TYPE_UINT64, counts.frames, "stacks",
                             G_TYPE_UINT64, counts.stacks, "dropped-stacks", G_TYPE_UINT64, counts.dropped,
                             "lost", G_TYPE_UINT64, counts.lost, "repeated", G_TYPE_UINT64, counts.repeated,
                             "late", G_TYPE_UINT64, counts.late, "reordered", G_TYPE_UINT64, counts.reordered,
                             "damaged", G_TYPE_UINT64, counts.damaged, nullptr);
}

void set_property(GObject *object, guint id, const GValue *value, GParamSpec *spec)
{
    GstFocalStackMux *self = GST_FOCAL_STACK_MUX(object);
    GST_OBJECT_LOCK(self);
    const bool known = dff::set_mux_property(self->state->settings, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

void get_property(GObject *object, guint id, GValue *value, GParamSpec *spec)
{
    GstFocalStackMux *self = GST_FOCAL_STACK_MUX(object);
    if (id == property_stats) {
        g_value_take_boxed(value, create_stats(self->state->core.statistics()));
        return;
    }
    GST_OBJECT_LOCK(self);
    const bool known = dff::get_mux_property(self->state->settings, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

void finalize(GObject *object)
{
    delete GST_FOCAL_STACK_MUX(object)->state;
    G_OBJECT_CLASS(gst_focal_stack_mux_parent_class)->finalize(object);
}

void install_properties(GObjectClass *object_class)
{
    dff::install_mux_properties(object_class);
    g_object_class_install_property(
        object_class, property_stats,
        g_param_spec_boxed(
            "stats", "Statistics",
            "Counts since the start, all guint64: frames that came, stacks sent, dropped-stacks; "
            "frames lost, repeated (came twice), late (after their sweep was over), reordered "
            "(put in their place), damaged (counted as lost too)",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

} // namespace

static void gst_focal_stack_mux_class_init(GstFocalStackMuxClass *klass)
{
    GObjectClass *object_class = G_OBJECT_CLASS(klass);
    GstElementClass *element_class = GST_ELEMENT_CLASS(klass);
    GST_DEBUG_CATEGORY_INIT(focalstackmux_debug, "focalstackmux", 0, "frames to focal stacks");

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_properties(object_class);

    element_class->request_new_pad = request_new_pad;
    element_class->release_pad = release_pad;
    element_class->change_state = change_state;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &plane_template);
    gst_element_class_add_static_pad_template(element_class, &source_template);
    gst_element_class_set_static_metadata(element_class, "Focal stack muxer", "Muxer/Video",
                                          "Puts the frames of focus sweeps together to focal stacks",
                                          "gst-plugins-dff authors");
}

static void gst_focal_stack_mux_init(GstFocalStackMux *self)
{
    self->source = gst_pad_new_from_static_template(&source_template, "src");
    self->state = new FocalStackMuxState(GST_ELEMENT(self), self->source);
    gst_pad_set_event_function(self->source, source_event);
    gst_pad_set_query_function(self->source, source_query);
    gst_element_add_pad(GST_ELEMENT(self), self->source);

    self->sink = gst_pad_new_from_static_template(&sink_template, "sink");
    add_input(self, self->sink, std::nullopt);
}
