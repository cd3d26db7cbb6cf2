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
#include "camera_source.h"
#include "dffdepth.h"
#include "forwarded_properties.h"

#include <gst/dff/dff.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

GST_DEBUG_CATEGORY(dff_camera_bin_debug);
#define GST_CAT_DEFAULT dff_camera_bin_debug

namespace {

enum Property : guint {
    PropertySource = 1,
    PropertyStats,
    PropertyDenoiseFrames,
    PropertyLocalMotion,
    FIRST_FORWARDED
};

/* A sink of planes stops at its first frame until the first stack is whole and everything has prerolled: two
 * of the longest sweeps. Stacks and pictures are large: two are enough to keep both sides of a branch busy.
 */
constexpr guint planes_in_wait = 128;
constexpr guint pictures_in_wait = 2;

/* The parts of the graph. The bin owns the elements; one that is not installed is nullptr.
 *
 *   source ! planes ! mux ! stacks ! (depth_valve) ! queue ! denoise ! denoised
 *   denoised ! queue ! dffdepth ! depths ! queue ! pad depth
 *   denoised ! (stack_valve) ! queue ! aif.stack,  depths ! (aif_valve) ! queue ! aif.depth
 *   aifcompose ! pictures ! queue ! pad aif
 *
 * and, when their pads are requested,
 *
 *   pictures ! queue ! videoconvert ! light.color,  depths ! queue ! light.depth,  light ! queue ! pad
 * lightfield planes ! queue ! pad planes,  stacks ! queue ! pad stacks
 *
 * A source of stacks goes straight to the tee stacks. A valve is shut while nobody wants what lies behind it.
 * The tees let the other branches go on when a pad is not linked. */
struct State {
    std::string source_text = "lenssweeptestsrc"; /* under the object lock, as the source's thread reads it */
    std::string source_error;
    std::string missing; /* an element that is not installed, or empty */
    GstElement *source = nullptr;
    GstElement *planes = nullptr;
    GstElement *mux = nullptr;
    GstElement *stacks = nullptr;
    GstElement *depth_valve = nullptr;
    GstElement *denoise = nullptr;
    GstElement *denoised = nullptr;
    GstElement *stack_valve = nullptr;
    GstElement *aif_valve = nullptr;
    GstElement *dffdepth = nullptr;
    GstElement *depths = nullptr;
    GstElement *aifcompose = nullptr;
    GstElement *pictures = nullptr;
    std::map<std::string, std::vector<GstElement *>> requested; /* what a request pad needs, by its name */
    GstPad *depth_pad = nullptr;
    GstPad *aif_pad = nullptr;
    std::optional<dff::SourceRoute> route;
};

} // namespace

struct _GstDffCameraBin {
    GstBin parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstDffCameraBin, gst_dff_camera_bin, GST_TYPE_BIN)
GST_ELEMENT_REGISTER_DEFINE(dffcamerabin, "dffcamerabin", GST_RANK_NONE, GST_TYPE_DFF_CAMERA_BIN)

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
    const State &state = *self->state;
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

static void build_graph(GstDffCameraBin *self)
{
    State &state = *self->state;
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
    State &state = *self->state;
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
    const State &state = *self->state;
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

/* lightfieldcompose between the pictures, the depths and `queue`; its parts are `parts`, nothing if it is not
 * installed. */
static std::vector<GstElement *> add_light_field(GstDffCameraBin *self, GstElement *queue)
{
    State &state = *self->state;
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
    const State &state = *self->state;
    if (tee && (tee == state.pictures || tee == state.depths || tee == state.planes || tee == state.stacks))
        gst_element_release_request_pad(tee, before);
}

static GstPad *request_new_pad(GstElement *element, GstPadTemplate *pad_template, const gchar *,
                               const GstCaps *)
{
    auto *self = GST_DFF_CAMERA_BIN(element);
    State &state = *self->state;
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

static void release_pad(GstElement *element, GstPad *pad)
{
    auto *self = GST_DFF_CAMERA_BIN(element);
    State &state = *self->state;
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
static std::vector<GstElement *> forwarded_to(const State &state)
{
    return {state.dffdepth, state.aifcompose};
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *spec)
{
    auto *self = GST_DFF_CAMERA_BIN(object);
    State &state = *self->state;
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
    self->state = new State;
    build_graph(self);
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
    element_class->request_new_pad = request_new_pad;
    element_class->release_pad = release_pad;
    for (GstStaticPadTemplate *pad_template :
         {&depth_template, &aif_template, &lightfield_template, &planes_template, &stacks_template})
        gst_element_class_add_static_pad_template(element_class, pad_template);
    gst_element_class_set_static_metadata(element_class, "Depth camera", "Source/Video",
                                          "Depth and all-in-focus pictures of a camera with a swept focus",
                                          "the gst-plugins-dff authors");
}
