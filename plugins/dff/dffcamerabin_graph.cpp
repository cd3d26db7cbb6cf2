/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "dffcamerabin_private.h"

#include <gst/dff/dff.h>

namespace {

/* A sink of planes stops at its first frame until the first stack is whole and everything has prerolled: two
 * of the longest sweeps. Stacks and pictures are large: two are enough to keep both sides of a branch busy.
 */
constexpr guint planes_in_wait = 128;
constexpr guint pictures_in_wait = 2;

} // namespace

static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw, format = (string) GRAY16_LE"));
static GstStaticPadTemplate aif_template =
    GST_STATIC_PAD_TEMPLATE("aif", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw"));
static GstStaticPadTemplate lightfield_template =
    GST_STATIC_PAD_TEMPLATE("lightfield", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS("video/x-raw"));
static GstStaticPadTemplate planes_template =
    GST_STATIC_PAD_TEMPLATE("planes", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS("video/x-raw"));
static GstStaticPadTemplate stacks_template = GST_STATIC_PAD_TEMPLATE(
    "stacks", GST_PAD_SRC, GST_PAD_REQUEST, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_NAME));

static GstElement *add(GstDffCameraBin *self, const char *factory, const char *name)
{
    GstElement *element = gst_element_factory_make(factory, name);
    if (element)
        gst_bin_add(GST_BIN(self), element);
    else
        self->state->missing = factory;
    return element;
}

static GstElement *add_queue(GstDffCameraBin *self, guint in_wait = pictures_in_wait)
{
    GstElement *queue = add(self, "queue", nullptr);
    if (queue)
        g_object_set(queue, "max-size-buffers", in_wait, "max-size-bytes", 0, "max-size-time", guint64{0},
                     nullptr);
    return queue;
}

static GstElement *add_tee(GstDffCameraBin *self, const char *name)
{
    GstElement *tee = add(self, "tee", name);
    if (tee)
        g_object_set(tee, "allow-not-linked", TRUE, nullptr);
    return tee;
}

static GstElement *add_valve(GstDffCameraBin *self, const char *name)
{
    GstElement *valve = add(self, "valve", name);
    if (valve)
        g_object_set(valve, "drop", TRUE, nullptr);
    return valve;
}

/* Opens and shuts the valves for what is linked. */
static void set_valves(GstDffCameraBin *self)
{
    const GstDffCameraBinState &state = *self->state;
    const bool aif = gst_pad_is_linked(state.aif_pad) || state.requested.contains("lightfield");
    const bool depth = gst_pad_is_linked(state.depth_pad) || aif;
    GST_DEBUG_OBJECT(self, "Depth is %s, pictures are %s", depth ? "computed" : "not wanted",
                     aif ? "composed" : "not wanted");
    g_object_set(state.depth_valve, "drop", !depth, nullptr);
    g_object_set(state.stack_valve, "drop", !aif, nullptr);
    g_object_set(state.aif_valve, "drop", !aif, nullptr);
}

/* A pad of the bin behind a queue. The tee between them takes what comes while the pad is not linked. */
static GstPad *add_output(GstDffCameraBin *self, GstStaticPadTemplate *static_template, GstElement *queue)
{
    GstElement *tee = add_tee(self, nullptr);
    gst_element_link(queue, tee);
    gst_element_sync_state_with_parent(tee);
    g_autoptr(GstPadTemplate) pad_template = gst_static_pad_template_get(static_template);
    g_autoptr(GstPad) target = gst_element_request_pad_simple(tee, "src_%u");
    GstPad *pad = gst_ghost_pad_new_from_template(static_template->name_template, target, pad_template);
    g_signal_connect_swapped(pad, "linked", G_CALLBACK(set_valves), self);
    g_signal_connect_swapped(pad, "unlinked", G_CALLBACK(set_valves), self);
    gst_pad_set_active(pad, GST_STATE(self) > GST_STATE_READY);
    gst_element_add_pad(GST_ELEMENT(self), pad);
    return pad;
}

void gst_dff_camera_bin_build_graph(GstDffCameraBin *self)
{
    GstDffCameraBinState &state = *self->state;
    GstElement *denoise_queue = add_queue(self), *stack_queue = add_queue(self),
               *aif_stack_queue = add_queue(self), *aif_depth_queue = add_queue(self),
               *depth_queue = add_queue(self), *aif_queue = add_queue(self);
    state.planes = add_tee(self, "plane-tee"); /* a pipeline's own elements may be called planes */
    state.mux = add(self, "focalstackmux", "mux");
    state.stacks = add_tee(self, "stacks");
    state.depth_valve = add_valve(self, "depth-valve");
    state.denoise = add(self, "focalstackdenoise", "denoise");
    state.denoised = add_tee(self, "denoised");
    state.stack_valve = add_valve(self, "stack-valve");
    state.aif_valve = add_valve(self, "aif-valve");
    state.dffdepth = add(self, "dffdepth", "dffdepth");
    state.depths = add_tee(self, "depths");
    state.aifcompose = add(self, "aifcompose", "aifcompose");
    state.pictures = add_tee(self, "pictures");
    if (!state.missing.empty())
        return;

    gst_element_link_pads(state.planes, "src_%u", state.mux, "sink"); /* not one of a plane */
    gst_element_link_pads(state.mux, "src", state.stacks, "sink");
    g_object_set(state.denoise, "frames", 1U, nullptr); /* leaves the stacks as they are */
    gst_element_link_many(state.stacks, state.depth_valve, denoise_queue, state.denoise, state.denoised,
                          nullptr);
    gst_element_link_many(state.denoised, stack_queue, state.dffdepth, state.depths, depth_queue, nullptr);
    gst_element_link_many(state.denoised, state.stack_valve, aif_stack_queue, nullptr);
    gst_element_link_many(state.depths, state.aif_valve, aif_depth_queue, nullptr);
    gst_element_link_pads(aif_stack_queue, "src", state.aifcompose, "stack");
    gst_element_link_pads(aif_depth_queue, "src", state.aifcompose, "depth");
    gst_element_link_many(state.aifcompose, state.pictures, aif_queue, nullptr);
    state.depth_pad = add_output(self, &depth_template, depth_queue);
    state.aif_pad = add_output(self, &aif_template, aif_queue);
}

/* lightfieldcompose between the pictures, the depths and `queue`; its parts are `parts`, nothing if it is not
 * installed. */
static std::vector<GstElement *> add_light_field(GstDffCameraBin *self, GstElement *queue)
{
    GstDffCameraBinState &state = *self->state;
    GstElement *compose = add(self, "lightfieldcompose", "lightfield");
    if (!compose) {
        GST_ELEMENT_WARNING(self, CORE, MISSING_PLUGIN,
                            ("The pad lightfield needs the element lightfieldcompose: install its plug-in"),
                            (nullptr));
        state.missing.clear();
        return {};
    }
    GstElement *colour_queue = add_queue(self), *depth_queue = add_queue(self),
               *convert = add(self, "videoconvert", nullptr);
    gst_element_link_many(state.pictures, colour_queue, convert, nullptr);
    gst_element_link(state.depths, depth_queue);
    gst_element_link_pads(convert, "src", compose, "color");
    gst_element_link_pads(depth_queue, "src", compose, "depth");
    gst_element_link(compose, queue);
    return {compose, convert, colour_queue, depth_queue};
}

/* Takes an element out of the bin, and away from the tee before it. */
static void remove(GstDffCameraBin *self, GstElement *element)
{
    g_autoptr(GstPad) sink = gst_element_get_static_pad(element, "sink");
    g_autoptr(GstPad) before = sink ? gst_pad_get_peer(sink) : nullptr;
    gst_element_set_state(element, GST_STATE_NULL);
    gst_bin_remove(GST_BIN(self), element);
    g_autoptr(GstElement) tee = before ? gst_pad_get_parent_element(before) : nullptr;
    const GstDffCameraBinState &state = *self->state;
    if (tee && (tee == state.pictures || tee == state.depths || tee == state.planes || tee == state.stacks))
        gst_element_release_request_pad(tee, before);
}

GstPad *gst_dff_camera_bin_request_new_pad(GstElement *element, GstPadTemplate *pad_template, const gchar *,
                                           const GstCaps *)
{
    auto *self = GST_DFF_CAMERA_BIN(element);
    GstDffCameraBinState &state = *self->state;
    const std::string name = GST_PAD_TEMPLATE_NAME_TEMPLATE(pad_template);
    if (state.requested.contains(name) || !state.missing.empty()) {
        GST_WARNING_OBJECT(self, "The pad %s is in use already, or elements are missing", name.c_str());
        return nullptr;
    }
    GstElement *queue = add_queue(self, name == "planes" ? planes_in_wait : pictures_in_wait);
    std::vector<GstElement *> parts;
    GstStaticPadTemplate *static_template = &lightfield_template;
    if (name == "lightfield") {
        parts = add_light_field(self, queue);
        if (parts.empty()) {
            remove(self, queue);
            return nullptr;
        }
    } else {
        const bool planes = name == "planes";
        static_template = planes ? &planes_template : &stacks_template;
        gst_element_link(planes ? state.planes : state.stacks, queue);
    }
    parts.insert(parts.begin(), queue);
    state.requested[name] = parts;
    GstPad *pad = add_output(self, static_template, queue);
    for (GstElement *part : parts)
        gst_element_sync_state_with_parent(part);
    set_valves(self);
    GST_INFO_OBJECT(self, "The pad %s is there", name.c_str());
    return pad;
}

void gst_dff_camera_bin_release_pad(GstElement *element, GstPad *pad)
{
    auto *self = GST_DFF_CAMERA_BIN(element);
    GstDffCameraBinState &state = *self->state;
    const std::string name = GST_PAD_NAME(pad);
    g_autoptr(GstPad) target = gst_ghost_pad_get_target(GST_GHOST_PAD(pad));
    g_autoptr(GstElement) last = gst_pad_get_parent_element(target);
    gst_pad_set_active(pad, FALSE);
    gst_element_remove_pad(element, pad);
    remove(self, last);
    for (GstElement *part : state.requested[name])
        remove(self, part);
    state.requested.erase(name);
    set_valves(self);
    GST_INFO_OBJECT(self, "The pad %s is gone", name.c_str());
}

void gst_dff_camera_bin_add_pad_templates(GstElementClass *element_class)
{
    for (GstStaticPadTemplate *pad_template :
         {&depth_template, &aif_template, &lightfield_template, &planes_template, &stacks_template})
        gst_element_class_add_static_pad_template(element_class, pad_template);
}
