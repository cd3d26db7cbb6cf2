/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-dffcamerabin
 * @title: dffcamerabin
 * @short_description: a depth camera in one element
 *
 * Hides the graph from swept planes to depth and all-in-focus pictures. `source` is any bin description that
 * gives frames with a GstFocusMeta (lenssweepsrc, lenssweeptestsrc, a camera and lenssweeptag, a recording)
 * or focal stacks.
 *
 * Link `depth`, `aif`, or both, before or while it runs; what is not linked is not computed. The request pad
 * `lightfield` gives pictures for a light-field display, where lightfieldcompose is installed. The request
 * pads `planes` and `stacks` give what the depth is computed from, to be recorded meanwhile.
 *
 * `denoise-frames` and `local-motion` are those of focalstackdenoise, through which what is computed goes;
 * the pad `stacks` gives the stacks as they came.
 *
 * The properties of dffdepth and aifcompose are properties of the bin as well; all others are reached as
 * child properties: `mux::on-missing=repeat`, `source::...`, `lightfield::layout=quilt`. `stats` holds the
 * `stats` of all its parts, those of the source included.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 dffcamerabin name=camera source="lenssweeptestsrc num-buffers=60" \
 *     camera.depth ! depthcolorize ! videoconvert ! autovideosink \
 *     camera.aif ! videoconvert ! autovideosink
 * gst-launch-1.0 dffcamerabin name=camera source="lenssweeptestsrc num-buffers=24" \
 *     camera.depth ! fakesink camera.stacks ! dffmetapay ! gdppay ! filesink location=stacks.gdp
 * gst-launch-1.0 dffcamerabin name=camera source="filesrc location=stacks.gdp ! gdpdepay ! dffmetadepay" \
 *     camera.depth ! fakesink
 * ]|
 */
#include "dffcamerabin.h"

#include "aifcompose.h"
#include "dffcamerabin_private.h"
#include "dffdepth.h"
#include "forwarded_properties.h"

#include <string>
#include <vector>

GST_DEBUG_CATEGORY(dff_camera_bin_debug);

namespace {

enum Property : guint {
    PropertySource = 1,
    PropertyStats,
    PropertyDenoiseFrames,
    PropertyLocalMotion,
    FIRST_FORWARDED
};

} // namespace

G_DEFINE_FINAL_TYPE(GstDffCameraBin, gst_dff_camera_bin, GST_TYPE_BIN)
GST_ELEMENT_REGISTER_DEFINE(dffcamerabin, "dffcamerabin", GST_RANK_NONE, GST_TYPE_DFF_CAMERA_BIN)

/* What comes from the source cannot be used. */
static void post_source_fault(GstDffCameraBin *self, const std::string &reason)
{
    GST_OBJECT_LOCK(self);
    const std::string text = self->state->source_text;
    GST_OBJECT_UNLOCK(self);
    GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS,
                      ("source=\"%s\" cannot be used: %s", text.c_str(), reason.c_str()), (nullptr));
}

static void replace_source(GstDffCameraBin *self)
{
    GstDffCameraBinState &state = *self->state;
    if (!state.missing.empty())
        return;
    if (state.source) {
        gst_element_set_state(state.source, GST_STATE_NULL);
        gst_bin_remove(GST_BIN(self), state.source);
        state.source = nullptr;
    }
    state.source_error.clear();
    GstElement *source = dff::make_camera_source(state.source_text, state.source_error);
    if (!source)
        return;
    gst_object_set_name(GST_OBJECT(source), "source");
    state.source = source;
    gst_bin_add(GST_BIN(self), source);
    g_autoptr(GstPad) pad = gst_element_get_static_pad(source, "src");
    state.source_error = state.route->connect(pad);
    GST_INFO_OBJECT(self, "The source is %s", state.source_text.c_str());
}

static GstStateChangeReturn change_state(GstElement *element, GstStateChange transition)
{
    auto *self = GST_DFF_CAMERA_BIN(element);
    const GstDffCameraBinState &state = *self->state;
    if (transition == GST_STATE_CHANGE_NULL_TO_READY || transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
        if (!state.missing.empty()) {
            GST_ELEMENT_ERROR(
                self, CORE, MISSING_PLUGIN,
                ("The element %s is missing: install the plug-in it belongs to", state.missing.c_str()),
                (nullptr));
            return GST_STATE_CHANGE_FAILURE;
        }
        if (!state.source_error.empty()) {
            post_source_fault(self, state.source_error);
            return GST_STATE_CHANGE_FAILURE;
        }
    }
    return GST_ELEMENT_CLASS(gst_dff_camera_bin_parent_class)->change_state(element, transition);
}

/* The stats of all elements that have some, by their names. */
static GstStructure *create_stats(GstDffCameraBin *self)
{
    GstStructure *all = gst_structure_new_empty("dffcamerabin-stats");
    const auto add_stats = [](const GValue *item, gpointer structure) {
        auto *element = G_OBJECT(g_value_get_object(item));
        const GParamSpec *spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), "stats");
        if (!spec || spec->value_type != GST_TYPE_STRUCTURE || GST_IS_BIN(element) ||
            g_str_equal(GST_OBJECT_NAME(element), dff::source_end))
            return;
        GstStructure *stats = nullptr;
        g_object_get(element, "stats", &stats, nullptr);
        if (stats)
            gst_structure_set(static_cast<GstStructure *>(structure), GST_OBJECT_NAME(element),
                              GST_TYPE_STRUCTURE, stats, nullptr);
        gst_clear_structure(&stats);
    };
    GstIterator *elements = gst_bin_iterate_recurse(GST_BIN(self));
    while (gst_iterator_foreach(elements, add_stats, all) == GST_ITERATOR_RESYNC)
        gst_iterator_resync(elements);
    gst_iterator_free(elements);
    return all;
}

/* What a property of the bin is called by focalstackdenoise; nullptr if it is none of it. */
static const char *denoiser_property(guint id)
{
    if (id == PropertyDenoiseFrames)
        return "frames";
    return id == PropertyLocalMotion ? "local-motion" : nullptr;
}

/* The parts whose properties are the bin's. */
static std::vector<GstElement *> forwarded_to(const GstDffCameraBinState &state)
{
    return {state.dffdepth, state.aifcompose};
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *spec)
{
    auto *self = GST_DFF_CAMERA_BIN(object);
    GstDffCameraBinState &state = *self->state;
    if (const char *name = denoiser_property(id)) {
        if (state.denoise)
            g_object_set_property(G_OBJECT(state.denoise), name, value);
        return;
    }
    if (id != PropertySource) {
        dff::set_forwarded_property(forwarded_to(state), value, spec);
        return;
    }
    if (GST_STATE(self) > GST_STATE_READY) {
        GST_WARNING_OBJECT(self, "source can be set in the states NULL and READY only");
        return;
    }
    GST_OBJECT_LOCK(self);
    state.source_text = g_value_get_string(value) ? g_value_get_string(value) : "";
    GST_OBJECT_UNLOCK(self);
    replace_source(self);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *spec)
{
    auto *self = GST_DFF_CAMERA_BIN(object);
    if (id == PropertyStats) {
        g_value_take_boxed(value, create_stats(self));
        return;
    }
    if (const char *name = denoiser_property(id)) {
        if (self->state->denoise)
            g_object_get_property(G_OBJECT(self->state->denoise), name, value);
        return;
    }
    if (id != PropertySource) {
        dff::get_forwarded_property(forwarded_to(*self->state), value, spec);
        return;
    }
    GST_OBJECT_LOCK(self);
    g_value_set_string(value, self->state->source_text.c_str());
    GST_OBJECT_UNLOCK(self);
}

/* Before the bin loses its children: what follows a pad's end needs them. */
static void dispose(GObject *object)
{
    auto *self = GST_DFF_CAMERA_BIN(object);
    for (const char *name : {"lightfield", "planes", "stacks"}) {
        g_autoptr(GstPad) pad = gst_element_get_static_pad(GST_ELEMENT(self), name);
        if (pad)
            gst_element_release_request_pad(GST_ELEMENT(self), pad);
    }
    for (const char *name : {"depth", "aif"}) {
        g_autoptr(GstPad) pad = gst_element_get_static_pad(GST_ELEMENT(self), name);
        if (pad)
            g_signal_handlers_disconnect_by_data(pad, self);
    }
    G_OBJECT_CLASS(gst_dff_camera_bin_parent_class)->dispose(object);
}

static void finalize(GObject *object)
{
    delete GST_DFF_CAMERA_BIN(object)->state;
    G_OBJECT_CLASS(gst_dff_camera_bin_parent_class)->finalize(object);
}

static void gst_dff_camera_bin_init(GstDffCameraBin *self)
{
    self->state = new GstDffCameraBinState;
    gst_dff_camera_bin_build_graph(self);
    self->state->route.emplace(self->state->planes, self->state->mux, self->state->stacks,
                               [self](const std::string &reason) { post_source_fault(self, reason); });
    replace_source(self);
}

static void gst_dff_camera_bin_class_init(GstDffCameraBinClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);

    GST_DEBUG_CATEGORY_INIT(dff_camera_bin_debug, "dffcamerabin", 0, "depth camera in one element");
    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->dispose = dispose;
    object_class->finalize = finalize;
    g_object_class_install_property(
        object_class, PropertySource,
        g_param_spec_string(
            "source", "Source",
            "What takes the planes: a bin description as in gst-launch-1.0 that ends in an open source pad, "
            "of "
            "frames with a GstFocusMeta or of focal stacks",
            "lenssweeptestsrc",
            static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY)));
    g_object_class_install_property(
        object_class, PropertyStats,
        g_param_spec_boxed(
            "stats", "Statistics",
            "The stats of the parts that have some, each a structure by the name of its element: mux, "
            "dffdepth, aifcompose, and those of the source",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
    const auto playing =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
    g_object_class_install_property(
        object_class, PropertyDenoiseFrames,
        g_param_spec_uint("denoise-frames", "Denoise frames",
                          "Sweeps that are averaged at most where nothing moves, for less noise in depth and "
                          "pictures; 1 leaves the stacks as they are",
                          1, 255, 1, playing));
    g_object_class_install_property(
        object_class, PropertyLocalMotion,
        g_param_spec_boolean("local-motion", "Local motion",
                             "Shows what moves during a sweep in all planes where it is in the middle of it",
                             FALSE, playing));
    dff::install_forwarded_properties(object_class, FIRST_FORWARDED,
                                      {GST_TYPE_DFF_DEPTH, GST_TYPE_AIF_COMPOSE});

    element_class->change_state = change_state;
    element_class->request_new_pad = gst_dff_camera_bin_request_new_pad;
    element_class->release_pad = gst_dff_camera_bin_release_pad;
    gst_dff_camera_bin_add_pad_templates(element_class);
    gst_element_class_set_static_metadata(element_class, "Depth camera", "Source/Video",
                                          "Depth and all-in-focus pictures of a camera with a swept focus",
                                          "the gst-plugins-dff authors");
}
