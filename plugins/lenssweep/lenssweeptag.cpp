/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-lenssweeptag
 * @title: lenssweeptag
 * @short_description: says which plane of which sweep a frame is
 *
 * Gives the frames of any source their #GstFocusMeta.
 *
 * With mode=cycle the lens cycles through its planes by itself, the first frame is plane 0, the nearest, and
 * frames are counted. Lost frames are counted too. Where the source numbers its frames (OFFSET_END = OFFSET +
 * 1, as v4l2src does) the numbers say how many are missing; without numbers, a frame with the flag DISCONT is
 * placed by its time and the frame rate. Where neither is known, or after a flush, the next frame begins a
 * new sweep; if that is a guess in the middle of a stream, a warning message is posted.
 *
 * With mode=step the element moves the lens: to a plane, waits until it rests, lets one frame through, and
 * goes on to the next plane. Frames of a live source that were exposed while the lens moved are dropped, by
 * their timestamps, and settle-frames more. `v4l2src ! lenssweeptag lens=v4l2:/dev/video0 mode=step` sweeps a
 * camera whose driver can focus; such a lens has no unit, so planes have no power, and the largest value of
 * its control is the nearest plane, unless lens-profile gives its positions at two or more vergences.
 *
 * `libcamerasrc name=cam ! lenssweeptag lens=element:cam.lens-position mode=step near=8 far=0` sweeps a
 * camera whose source moves its lens, some frames after it was asked. settle-frames is counted from the frame
 * for which the property reads the plane. Where nobody knows when the lens rests, as with element: and v4l2:,
 * it is held for eight frames more now and then, and a warning is posted if sharpness shows that it still
 * moved at the label.
 *
 * With mode=sync the lens sweeps by itself, or in the hands of the FPGA (lens=fpga:/dev/i2c-1), and sync-line
 * has an edge whenever plane 0 is exposed. An Optotune lens driver (lens=optotune:/dev/ttyACM0, and a profile
 * in mA) moves its lens to and fro: its pin A on sync-line rises at the near end, and every second sweep goes
 * from the farthest plane to the nearest. A frame is let through only if edges and frames agree on its plane;
 * the others are dropped and counted in stats. See timestamp-delay for cameras that stamp frames late.
 *
 * Where the planes lie is said by near and far, or by powers, or by a lens that knows its powers and is moved
 * here. Otherwise it is not known, and depth can only be in plane numbers: no distance is invented.
 *
 * A microscope has no vergences but stage positions: positions, or step-um for even steps, give them in
 * micrometres, and `dffdepth unit=micrometre` heights.
 *
 * Pixels are neither copied nor touched.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 -v videotestsrc num-buffers=60 ! lenssweeptag planes=10 near=4 far=0.5 ! \
 *     fakesink silent=false
 * ]|
 */
#include "lenssweeptag.h"

#include "block_sharpness.h"
#include "common/checked_properties.h"
#include "common/running_time.h"
#include "common/whole_frame.h"
#include "element_property.h"
#include "monotonic_lead.h"
#include "sweep_tagger.h"

#include <exception>
#include <gst/dff/dff.h>
#include <gst/video/video.h>

GST_DEBUG_CATEGORY_STATIC(gst_lens_sweep_tag_debug);
#define GST_CAT_DEFAULT gst_lens_sweep_tag_debug

#define CAPS "video/x-raw(ANY); video/x-bayer(ANY)"

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));

namespace {

enum { PROP_STATS = first_id_after_tag_properties };

struct TagCounts {
    guint64 frames = 0;
    guint64 labelled = 0;
    guint64 dropped = 0;
};

} // namespace

struct GstLensSweepTagState {
    /* Guarded by the object lock. */
    TagSettings settings;
    TagCounts counts;
    std::stop_source stop; /* of a wait for the lens; requested while flushing or stopping */

    /* Guarded by the sink pad's stream lock, while started. */
    std::unique_ptr<SweepTagger> tagger;
    guint64 frames = 0;
    std::optional<GstVideoInfo> video; /* of frames whose sharpness can be measured */
};

struct _GstLensSweepTag {
    GstBaseTransform parent;
    GstLensSweepTagState *state;
};

G_DEFINE_FINAL_TYPE(GstLensSweepTag, gst_lens_sweep_tag, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(lenssweeptag, "lenssweeptag", GST_RANK_NONE, GST_TYPE_LENS_SWEEP_TAG,
                                      GST_DEBUG_CATEGORY_INIT(gst_lens_sweep_tag_debug, "lenssweeptag", 0,
                                                              "labels of swept planes"))

static gboolean start(GstBaseTransform *transform)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GstLensSweepTagState &state = *self->state;
    GST_OBJECT_LOCK(self);
    const TagSettings settings = state.settings;
    state.counts = {};
    GST_OBJECT_UNLOCK(self);
    state.frames = 0;
    try {
        if (const auto fault = dff::value_out_of_range(G_OBJECT(self)))
            throw std::invalid_argument(*fault);
        state.tagger = std::make_unique<SweepTagger>(
            settings, [self](const std::string &element, const std::string &property) {
                return find_element_property(GST_ELEMENT(self), element, property);
            });
        GST_INFO_OBJECT(self, "%u planes of %g to %g dioptres (NAN: not known), lens %s",
                        state.tagger->planes(), state.tagger->power(0),
                        state.tagger->power(state.tagger->planes() - 1), settings.lens.c_str());
    } catch (const std::invalid_argument &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("The properties cannot be used: %s.", error.what()),
                          (nullptr));
        return FALSE;
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ_WRITE, ("The sweep cannot begin: %s.", error.what()),
                          (nullptr));
        return FALSE;
    }
    return TRUE;
}

static gboolean stop(GstBaseTransform *transform)
{
    GST_LENS_SWEEP_TAG(transform)->state->tagger.reset();
    return TRUE;
}

/* Frames of 8 bits a sample in the memory of this machine. */
static std::optional<GstVideoInfo> measurable_video(const GstCaps *caps)
{
    GstVideoInfo info;
    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    const GstCapsFeatures *features = gst_caps_get_features(caps, 0);
    const bool plain = gst_structure_has_name(structure, "video/x-raw") &&
                       gst_caps_features_contains(features, GST_CAPS_FEATURE_MEMORY_SYSTEM_MEMORY) &&
                       gst_video_info_from_caps(&info, caps);
    const bool measurable = plain && GST_VIDEO_INFO_COMP_DEPTH(&info, 0) == 8;
    return measurable ? std::optional(info) : std::nullopt;
}

static std::vector<double> sharpness_of(const GstVideoInfo &info, GstBuffer *buffer)
{
    GstVideoFrame frame;
    if (!dff::map_whole(frame, info, buffer, GST_MAP_READ))
        return {};
    const PictureView picture{static_cast<const guint8 *>(GST_VIDEO_FRAME_COMP_DATA(&frame, 0)),
                              static_cast<unsigned>(GST_VIDEO_FRAME_COMP_WIDTH(&frame, 0)),
                              static_cast<unsigned>(GST_VIDEO_FRAME_COMP_HEIGHT(&frame, 0)),
                              static_cast<size_t>(GST_VIDEO_FRAME_COMP_STRIDE(&frame, 0)),
                              static_cast<size_t>(GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0))};
    auto sharpness = block_sharpness(picture);
    gst_video_frame_unmap(&frame);
    return sharpness;
}

static std::optional<uint64_t> frame_period(const GstCaps *caps)
{
    gint numerator = 0;
    gint denominator = 1;
    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    if (!gst_structure_get_fraction(structure, "framerate", &numerator, &denominator) || numerator <= 0)
        return std::nullopt;
    return gst_util_uint64_scale_int(GST_SECOND, denominator, numerator);
}

static gboolean set_caps(GstBaseTransform *transform, GstCaps *caps, GstCaps *)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GST_INFO_OBJECT(self, "caps %" GST_PTR_FORMAT, caps);
    self->state->video = measurable_video(caps);
    try {
        self->state->tagger->set_period(frame_period(caps));
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(
            self, RESOURCE, SETTINGS,
            ("The lens cannot make this sweep at the frame rate of this stream: %s.", error.what()),
            (nullptr));
        return FALSE;
    }
    return TRUE;
}

/* Ends waits for the lens, or lets them begin again. */
static void set_interrupted(GstLensSweepTag *self, bool interrupted)
{
    GST_OBJECT_LOCK(self);
    if (interrupted)
        self->state->stop.request_stop();
    else
        self->state->stop = {};
    GST_OBJECT_UNLOCK(self);
}

static gboolean sink_event(GstBaseTransform *transform, GstEvent *event)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_START)
        set_interrupted(self, true);
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
        set_interrupted(self, false);
        self->state->tagger->restart();
    }
    return GST_BASE_TRANSFORM_CLASS(gst_lens_sweep_tag_parent_class)->sink_event(transform, event);
}

static GstStateChangeReturn change_state(GstElement *element, GstStateChange transition)
{
    if (transition == GST_STATE_CHANGE_READY_TO_PAUSED || transition == GST_STATE_CHANGE_PAUSED_TO_READY)
        set_interrupted(GST_LENS_SWEEP_TAG(element), transition == GST_STATE_CHANGE_PAUSED_TO_READY);
    return GST_ELEMENT_CLASS(gst_lens_sweep_tag_parent_class)->change_state(element, transition);
}

/* A buffer of others is copied without its pixels, since only a meta is added. */
static GstFlowReturn prepare_output_buffer(GstBaseTransform *, GstBuffer *input, GstBuffer **output)
{
    *output = gst_buffer_is_writable(input) ? input : gst_buffer_copy(input);
    return GST_FLOW_OK;
}

static FrameTrace trace_of(const GstBuffer *buffer)
{
    FrameTrace trace;
    const bool numbered = GST_BUFFER_OFFSET_IS_VALID(buffer) && GST_BUFFER_OFFSET_END_IS_VALID(buffer) &&
                          GST_BUFFER_OFFSET_END(buffer) == GST_BUFFER_OFFSET(buffer) + 1;
    if (numbered)
        trace.number = GST_BUFFER_OFFSET(buffer);
    if (GST_BUFFER_PTS_IS_VALID(buffer))
        trace.time_ns = GST_BUFFER_PTS(buffer);
    trace.discontinuous = GST_BUFFER_IS_DISCONT(buffer);
    return trace;
}

/* The time of a frame on CLOCK_MONOTONIC, in which the kernel stamps edges; unknown without a running clock.
 */
static std::optional<uint64_t> monotonic_time_of(GstBaseTransform *transform, const GstBuffer *buffer)
{
    g_autoptr(GstClock) clock = gst_element_get_clock(GST_ELEMENT(transform));
    const GstClockTime running = dff::running_time(transform->segment, GST_BUFFER_PTS(buffer));
    if (!clock || !GST_CLOCK_TIME_IS_VALID(running))
        return std::nullopt;
    const GstClockTime stamped = gst_element_get_base_time(GST_ELEMENT(transform)) + running;
    return stamped + static_cast<uint64_t>(monotonic_lead(clock));
}

static std::optional<PlaneLabel> find_label(GstLensSweepTag *self, GstBuffer *buffer, const FrameTrace &trace)
{
    SweepTagger &tagger = *self->state->tagger;
    const auto time = monotonic_time_of(GST_BASE_TRANSFORM(self), buffer);
    GST_OBJECT_LOCK(self);
    const std::stop_token stop = self->state->stop.get_token();
    GST_OBJECT_UNLOCK(self);
    const auto label = tagger.label(trace, time, stop, [self, buffer] {
        return self->state->video ? sharpness_of(*self->state->video, buffer) : std::vector<double>{};
    });
    GST_LOG_OBJECT(self, "frame of %" GST_TIME_FORMAT " is plane %d",
                   GST_TIME_ARGS(time.value_or(GST_CLOCK_TIME_NONE)),
                   label ? static_cast<int>(label->plane) : -1);
    const std::string warning = tagger.warning();
    if (!warning.empty())
        GST_ELEMENT_WARNING(self, STREAM, FAILED, ("%s", warning.c_str()), (nullptr));
    return label;
}

static void add_focus_meta(const SweepTagger &tagger, GstBuffer *buffer, const PlaneLabel &label,
                           guint64 frame_id)
{
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = label.sweep;
    focus.plane = label.plane;
    focus.planes = tagger.planes();
    focus.power = tagger.power(label.plane);
    focus.position_um = tagger.position_um(label.plane);
    focus.code = tagger.code(label.plane);
    focus.frame_id = frame_id;
    if (GstFocusMeta *old = gst_buffer_get_focus_meta(buffer))
        gst_buffer_remove_meta(buffer, &old->meta);
    gst_buffer_add_focus_meta(buffer, &focus);
}

static GstFlowReturn transform_ip(GstBaseTransform *transform, GstBuffer *buffer)
{
    auto *self = GST_LENS_SWEEP_TAG(transform);
    GstLensSweepTagState &state = *self->state;
    const FrameTrace trace = trace_of(buffer);
    std::optional<PlaneLabel> label;
    try {
        label = find_label(self, buffer, trace);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("The sweep has stopped: %s.", error.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
    const guint64 frame_id = trace.number.value_or(state.frames);
    state.frames++;
    GST_OBJECT_LOCK(self);
    state.counts.frames++;
    (label ? state.counts.labelled : state.counts.dropped)++;
    GST_OBJECT_UNLOCK(self);
    if (!label)
        return GST_BASE_TRANSFORM_FLOW_DROPPED;
    add_focus_meta(*state.tagger, buffer, *label, frame_id);
    return GST_FLOW_OK;
}

/* Called with the object lock held. */
static GstStructure *new_stats(const TagCounts &counts)
{
    return gst_structure_new("application/x-lens-sweep-tag-stats", "frames", G_TYPE_UINT64, counts.frames,
                             "labelled", G_TYPE_UINT64, counts.labelled, "dropped", G_TYPE_UINT64,
                             counts.dropped, nullptr);
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TAG(object);
    GST_OBJECT_LOCK(self);
    const bool known = set_tag_property(self->state->settings, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    auto *self = GST_LENS_SWEEP_TAG(object);
    GST_OBJECT_LOCK(self);
    bool known = true;
    if (id == PROP_STATS)
        g_value_take_boxed(value, new_stats(self->state->counts));
    else
        known = get_tag_property(self->state->settings, id, value);
    GST_OBJECT_UNLOCK(self);
    if (!known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_LENS_SWEEP_TAG(object)->state;
    G_OBJECT_CLASS(gst_lens_sweep_tag_parent_class)->finalize(object);
}

static void gst_lens_sweep_tag_init(GstLensSweepTag *self)
{
    self->state = new GstLensSweepTagState;
}

static void gst_lens_sweep_tag_class_init(GstLensSweepTagClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);
    auto *transform_class = GST_BASE_TRANSFORM_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_tag_properties(object_class);
    g_object_class_install_property(
        object_class, PROP_STATS,
        g_param_spec_boxed(
            "stats", "Statistics",
            "Counts since the start: frames that came in, those labelled, and those dropped since the "
            "lens moved (step) or their plane was not sure (sync)",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));

    element_class->change_state = change_state;
    transform_class->start = start;
    transform_class->stop = stop;
    transform_class->set_caps = set_caps;
    transform_class->sink_event = sink_event;
    transform_class->prepare_output_buffer = prepare_output_buffer;
    transform_class->transform_ip = transform_ip;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_set_static_metadata(element_class, "Focus sweep labeller", "Filter/Video",
                                          "Says which plane of which focus sweep each frame is",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(gst_lens_sweep_tag_mode_get_type(), static_cast<GstPluginAPIFlags>(0));
}
