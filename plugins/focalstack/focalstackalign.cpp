/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-focalstackalign
 *
 * Brings the planes of each focal stack onto its middle plane, number planes / 2: undoes the zoom that comes
 * with focusing (focus breathing), vibration, and the shake of a hand while the sweep was taken.
 *
 * How each plane lies is found in its pictures, by following corners between planes (Lucas-Kanade, RANSAC)
 * and solving for all planes together. Pictures of every size are matched at 160, 480 and 1000 pixels, so
 * that planes far apart in focus find each other while they are small. With motion-model=auto it is shift,
 * turn and zoom, or a homography where that explains clearly more, as it does for a phone in the hand. What
 * parallax does to a scene of some depth when the camera itself moves cannot be undone by a warp.
 *
 * A plane is trusted if its corners lie where the warp says, in all quarters of the picture, and if no other
 * shift fits as well, as on a keyboard. Of a plane that is not trusted nothing is taken: it gets the picture
 * of its neighbour, softened, and the stack's meta says that it repeats that. A plane without texture, of
 * which nothing can be said, goes with its neighbours. Each of the two is told once, by a warning, and by
 * `stats`.
 *
 * Moved planes are resampled with Lanczos' kernel, since with a softer one noise and sharpness differ from
 * plane to plane, which is what depth from focus looks at. Size stays; what a plane does not show, farther
 * than 4 pixels beyond its border, is taken from its neighbour towards the middle, so that depth and
 * all-in-focus picture come from the planes that do show it. Planes that lie within 0.02 pixels of their
 * place are copied.
 *
 * With even-brightness=true all planes get the brightness and the colours of the plane in between, by a gain
 * and an offset a channel: lights flicker, and cameras meter each photograph anew. It takes a few
 * milliseconds for each megapixel of a stack.
 *
 * Pixels of the sensor that are too bright or too dark in all planes, whatever is before them, hot and dead
 * ones, become the median of their neighbours before anything else. They are known after three parts of the
 * scene have come before them: while nothing moves they may be the scene's own.
 *
 * Before focalstackdenoise it also undoes what a hand's shake did from stack to stack to parts of a pixel, to
 * turn (up to 4 pixels at the corners) and zoom, and tells the rest, an even number of pixels, with each
 * stack: a GstCustomMeta by the name GstFocalStackPlaceMeta, with the fields "anchor" (uint), "right" and
 * "down" (int). Its pixel (x, y) shows what (x + right, y + down) of the stack `anchor` shows. The picture
 * still follows the camera.
 *
 * With mode=calibration the warps come from a file instead, for a rig whose lens always breathes the same; it
 * costs less, and scenes without texture do no harm. The file holds what `stats` told of a textured scene.
 *
 * A stack without times gets those of its caps' frame rate.
 *
 * ## Example pipeline
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 breathing=0.03 ! focalstackmux ! queue ! \
 *     focalstackalign ! queue ! dffdepth ! fakesink
 * ]| computes depth from sweeps whose planes differ in zoom by 3 percent.
 */
#include "focalstack/focalstackalign.h"

#include "common/stack_clock.h"
#include "common/stack_noise.h"
#include "common/stack_place.h"
#include "focalstack/alignment_calibration.h"
#include "focalstack/alignment_statistics.h"
#include "focalstack/bad_pixels.h"
#include "focalstack/brightness_evener.h"
#include "focalstack/focalstackalign_properties.h"
#include "focalstack/partial_stack.h"
#include "focalstack/plane_placing.h"
#include "focalstack/scene_anchor.h"
#include "focalstack/stack_aligner.h"
#include "focalstack/stack_pictures.h"

#include <optional>
#include <stdexcept>

GST_DEBUG_CATEGORY_STATIC(focalstackalign_debug);
#define GST_CAT_DEFAULT focalstackalign_debug

namespace {

struct FocalStackAlignState {
    /* Guarded by the sink pad's stream lock. */
    std::optional<dff::StackPool> pool;
    dff::StackClock clock;
    bool told_untrusted = false;
    bool told_blank = false;
    std::optional<dff::AlignmentCalibration> calibration; /* with mode=calibration */
    dff::BadPixels bad_pixels;
    bool tells_place = false; /* somebody downstream averages stacks */
    dff::SceneAnchor anchor;  /* if so */

    /* Guarded by the object's lock. */
    dff::AlignSettings settings;
    dff::AlignmentStatistics statistics;
    GstClockTime latency = 0;
};

constexpr guint property_stats = dff::align_properties_end;

GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_MAKE));
GstStaticPadTemplate source_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_MAKE));

} // namespace

struct _GstFocalStackAlign {
    GstBaseTransform parent;
    FocalStackAlignState *state;
};

G_DEFINE_FINAL_TYPE(GstFocalStackAlign, gst_focal_stack_align, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE(focalstackalign, "focalstackalign", GST_RANK_NONE, GST_TYPE_FOCAL_STACK_ALIGN)

namespace {

class ObjectLock {
public:
    explicit ObjectLock(gpointer object) : object_(GST_OBJECT(object)) { GST_OBJECT_LOCK(object_); }
    ~ObjectLock() { GST_OBJECT_UNLOCK(object_); }
    ObjectLock(const ObjectLock &) = delete;
    ObjectLock &operator=(const ObjectLock &) = delete;

private:
    GstObject *object_;
};

std::optional<dff::MotionModel> model_of(dff::MotionChoice choice)
{
    switch (choice) {
    case dff::MotionChoice::Similarity:
        return dff::MotionModel::Similarity;
    case dff::MotionChoice::Homography:
        return dff::MotionModel::Homography;
    default:
        return {};
    }
}

std::vector<dff::PlaneAlignment> estimate(GstFocalStackAlign *self, const dff::StackPictures &pictures,
                                          unsigned planes, dff::MotionChoice choice)
{
    try {
        std::vector<cv::Mat> lumas;
        for (unsigned z = 0; z < planes; z++)
            lumas.push_back(pictures.component(z, 0));
        return dff::align_stack(lumas, model_of(choice));
    } catch (const cv::Exception &exception) {
        GST_WARNING_OBJECT(self, "the stack is left as it is: %s", exception.what());
        return std::vector<dff::PlaneAlignment>(planes, {.warp = {}, .trusted = false, .blank = true});
    }
}

std::vector<dff::PlaneAlignment> find_alignments(GstFocalStackAlign *self, const dff::StackPictures &pictures,
                                                 unsigned planes, const dff::AlignSettings &settings)
{
    const FocalStackAlignState &state = *self->state;
    return state.calibration ? state.calibration->alignments(pictures.component(0, 0).size(), planes)
                             : estimate(self, pictures, planes, settings.motion_model);
}

void place_planes(const dff::StackPictures &from, const dff::StackPictures &to,
                  std::span<const dff::PlaneAlignment> alignments, bool even)
{
    for (unsigned i = 0; i < from.components(); i++) {
        std::vector<cv::Mat> aligned;
        for (unsigned z = 0; z < alignments.size(); z++) {
            aligned.push_back(to.component(z, i));
            if (dff::is_shown(alignments[z]))
                dff::undo_warp(from.component(z, i), aligned[z], alignments[z].warp, from.step(i));
        }
        if (even)
            dff::even_brightness(aligned, alignments, from.black(i), from.step(i));
        dff::fill_hidden(aligned, alignments, from.step(i));
    }
}

/* Planes that show their neighbour's picture. */
void tell_repeated(GstBuffer *stack, std::span<const dff::PlaneAlignment> alignments)
{
    GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack);
    for (std::size_t z = 0; meta && z < alignments.size(); z++)
        if (!dff::is_shown(alignments[z]))
            meta->repeated |= guint64{1} << z;
}

/* Each cause once, until the element is started anew. */
void tell_of_trust(GstFocalStackAlign *self, std::span<const dff::PlaneAlignment> alignments)
{
    FocalStackAlignState &state = *self->state;
    const std::string untrusted = dff::numbers_of(alignments, false),
                      blank = dff::numbers_of(alignments, true);

    GST_DEBUG_OBJECT(self, "planes not trusted: %s; without texture: %s",
                     untrusted.empty() ? "none" : untrusted.c_str(), blank.empty() ? "none" : blank.c_str());
    if (!untrusted.empty() && !state.told_untrusted) {
        state.told_untrusted = true;
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Planes %s of a stack of %zu do not fit the others by any shift, turn, zoom or perspective. "
             "Nothing is "
             "taken from them. Hold the camera still, or give the planes in the order of their focus.",
             untrusted.c_str(), alignments.size()),
            ("said once; the property stats tells the planes of every stack"));
    }
    if (!blank.empty() && !state.told_blank) {
        state.told_blank = true;
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Planes %s of a stack of %zu show no texture by which they could be aligned. They are "
             "moved with their neighbours.",
             blank.c_str(), alignments.size()),
            ("said once; the property stats tells the planes of every stack"));
    }
}

/* The latency only ever grows, with some room, so that it is seldom announced. */
void announce_latency(GstFocalStackAlign *self, GstClockTime measured)
{
    {
        const ObjectLock lock(self);
        if (measured <= self->state->latency)
            return;
        self->state->latency = measured + measured / 4;
    }
    gst_element_post_message(GST_ELEMENT(self), gst_message_new_latency(GST_OBJECT(self)));
}

gboolean set_caps(GstBaseTransform *base, GstCaps *caps, GstCaps *)
{
    GstFocalStackInfo info;

    GST_INFO_OBJECT(base, "caps %" GST_PTR_FORMAT, caps);
    if (!gst_focal_stack_info_from_caps(&info, caps))
        return FALSE;
    if (const auto problem = dff::too_large(info)) {
        GST_ELEMENT_ERROR(base, RESOURCE, NO_SPACE_LEFT, ("%s", problem->c_str()), (nullptr));
        return FALSE;
    }
    GST_FOCAL_STACK_ALIGN(base)->state->pool.emplace(info);
    GST_FOCAL_STACK_ALIGN(base)->state->bad_pixels.forget();
    GST_FOCAL_STACK_ALIGN(base)->state->anchor.forget();
    return TRUE;
}

/* Downstream's buffers are of no use: a stack is one memory with slack at both ends. */
gboolean decide_allocation(GstBaseTransform *base, GstQuery *query)
{
    GST_FOCAL_STACK_ALIGN(base)->state->tells_place =
        gst_query_find_allocation_meta(query, dff::stack_place_meta_api(), nullptr);
    while (gst_query_get_n_allocation_pools(query) > 0)
        gst_query_remove_nth_allocation_pool(query, 0);
    return TRUE;
}

/* Any layout will do. */
gboolean propose_allocation(GstBaseTransform *, GstQuery *, GstQuery *query)
{
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
    return TRUE;
}

GstFlowReturn prepare_output_buffer(GstBaseTransform *base, GstBuffer *input, GstBuffer **output)
{
    GstFocalStackAlign *self = GST_FOCAL_STACK_ALIGN(base);
    dff::BufferPtr stack = self->state->pool->acquire();

    if (!stack) {
        GST_ELEMENT_ERROR(self, RESOURCE, NO_SPACE_LEFT,
                          ("There is no memory for another focal stack of %" G_GSIZE_FORMAT
                           " bytes: lower planes, or the width and height of the pictures.",
                           gst_focal_stack_info_get_size(&self->state->pool->info())),
                          (nullptr));
        return GST_FLOW_ERROR;
    }
    GST_BASE_TRANSFORM_GET_CLASS(base)->copy_metadata(base, input, stack.get());
    dff::tell_stack_noise(stack.get(), std::nullopt); /* planes that are warped have less */
    *output = stack.release();
    return GST_FLOW_OK;
}

/* All that is known of the stack holds of the aligned one too, but for its layout, which the base class
 * leaves out and the pool writes anew. */
gboolean transform_meta(GstBaseTransform *, GstBuffer *, GstMeta *, GstBuffer *)
{
    return TRUE;
}

/* Before anything else: what lies at the same place of all planes would hold them fast. */
void leave_out_bad_pixels(dff::BadPixels &known, GstBuffer *stack, dff::StackPictures &pictures,
                          unsigned planes)
{
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack);
    const guint64 absent = meta ? meta->missing | meta->repeated : 0;
    std::vector<cv::Mat> taken;
    for (unsigned z = 0; z < planes; z++)
        if (!(absent >> z & 1))
            taken.push_back(pictures.component(z, 0));
    known.look(taken);
    pictures.leave_out(known.places());
}

/* The same planes, as they are to be placed for somebody who averages stacks; tells where this one lies. */
std::vector<dff::PlaneAlignment> in_scene(GstFocalStackAlign *self, const dff::StackPictures &pictures,
                                          std::vector<dff::PlaneAlignment> alignments, GstBuffer *output)
{
    FocalStackAlignState &state = *self->state;
    if (!state.tells_place || state.calibration)
        return alignments;
    const auto middle = static_cast<unsigned>(dff::middle_plane(alignments.size()));
    const dff::PlaneWarp rest = state.anchor.rest_of(pictures.component(middle, 0));
    for (dff::PlaneAlignment &alignment : alignments)
        alignment.warp = dff::PlaneWarp(alignment.warp.matrix() * rest.matrix());
    const cv::Point shift = state.anchor.shift();
    GST_DEBUG_OBJECT(self, "%d pixels right of anchor %u, %d down", shift.x, state.anchor.anchors(), shift.y);
    dff::tell_stack_place(output, {state.anchor.anchors(), shift.x, shift.y});
    return alignments;
}

GstFlowReturn transform(GstBaseTransform *base, GstBuffer *input, GstBuffer *output)
{
    GstFocalStackAlign *self = GST_FOCAL_STACK_ALIGN(base);
    const GstFocalStackInfo &info = self->state->pool->info();
    const gint64 start_us = g_get_monotonic_time();
    g_autoptr(GError) error = nullptr;

    const auto from = dff::StackPictures::map(info, input, GST_MAP_READ, &error);
    const auto to = from ? dff::StackPictures::map(info, output, GST_MAP_WRITE, &error) : nullptr;
    if (!to) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s", error->message), (nullptr));
        return GST_FLOW_ERROR;
    }
    dff::AlignSettings settings;
    {
        const ObjectLock lock(self);
        settings = self->state->settings;
    }
    std::vector<dff::PlaneAlignment> alignments;
    try {
        leave_out_bad_pixels(self->state->bad_pixels, input, *from, info.planes);
        alignments = find_alignments(self, *from, info.planes, settings);
        place_planes(*from, *to, in_scene(self, *from, alignments, output), settings.even_brightness);
    } catch (const cv::Exception &exception) {
        GST_ELEMENT_ERROR(self, STREAM, FAILED, ("The planes of the stack cannot be warped."),
                          ("%s", exception.what()));
        return GST_FLOW_ERROR;
    } catch (const std::runtime_error &mismatch) {
        GST_ELEMENT_ERROR(self, STREAM, WRONG_TYPE, ("%s", mismatch.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
    self->state->clock.stamp(output, info.frame);
    tell_repeated(output, alignments);
    tell_of_trust(self, alignments);
    {
        const ObjectLock lock(self);
        self->state->statistics.add(std::move(alignments), self->state->bad_pixels.places().size());
    }
    announce_latency(self, static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND);
    return GST_FLOW_OK;
}

gboolean sink_event(GstBaseTransform *base, GstEvent *event)
{
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP)
        GST_FOCAL_STACK_ALIGN(base)->state->anchor.forget();
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT) {
        const GstSegment *segment = nullptr;
        gst_event_parse_segment(event, &segment);
        const GstSegment time = GST_FOCAL_STACK_ALIGN(base)->state->clock.begin(*segment);
        if (segment->format != GST_FORMAT_TIME) {
            GstEvent *replacement = gst_event_new_segment(&time);
            gst_event_set_seqnum(replacement, gst_event_get_seqnum(event));
            gst_event_unref(event);
            event = replacement;
        }
    }
    return GST_BASE_TRANSFORM_CLASS(gst_focal_stack_align_parent_class)->sink_event(base, event);
}

gboolean query(GstBaseTransform *base, GstPadDirection direction, GstQuery *query)
{
    const gboolean answered =
        GST_BASE_TRANSFORM_CLASS(gst_focal_stack_align_parent_class)->query(base, direction, query);
    if (!answered || direction != GST_PAD_SRC || GST_QUERY_TYPE(query) != GST_QUERY_LATENCY)
        return answered;

    gboolean live = FALSE;
    GstClockTime least = 0, most = GST_CLOCK_TIME_NONE;
    gst_query_parse_latency(query, &live, &least, &most);
    const ObjectLock lock(base);
    const GstClockTime own = GST_FOCAL_STACK_ALIGN(base)->state->latency;
    gst_query_set_latency(query, live, least + own, GST_CLOCK_TIME_IS_VALID(most) ? most + own : most);
    return TRUE;
}

gboolean load_calibration(GstFocalStackAlign *self)
{
    FocalStackAlignState *state = self->state;
    dff::AlignSettings settings;
    {
        const ObjectLock lock(self);
        settings = state->settings;
    }
    state->calibration.reset();
    if (settings.mode == dff::AlignMode::Estimate)
        return TRUE;
    try {
        state->calibration = dff::AlignmentCalibration::load(settings.calibration);
        return TRUE;
    } catch (const std::runtime_error &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
        return FALSE;
    }
}

gboolean start(GstBaseTransform *base)
{
    FocalStackAlignState *state = GST_FOCAL_STACK_ALIGN(base)->state;

    if (!load_calibration(GST_FOCAL_STACK_ALIGN(base)))
        return FALSE;
    const ObjectLock lock(base);
    state->clock = {};
    state->told_untrusted = state->told_blank = false;
    state->statistics = {};
    state->bad_pixels.forget();
    state->latency = 0;
    return TRUE;
}

gboolean stop(GstBaseTransform *base)
{
    GST_FOCAL_STACK_ALIGN(base)->state->pool.reset();
    GST_FOCAL_STACK_ALIGN(base)->state->anchor.forget();
    return TRUE;
}

void set_property(GObject *object, guint id, const GValue *value, GParamSpec *spec)
{
    const ObjectLock lock(object);
    if (!dff::set_align_property(GST_FOCAL_STACK_ALIGN(object)->state->settings, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

void get_property(GObject *object, guint id, GValue *value, GParamSpec *spec)
{
    const ObjectLock lock(object);
    const FocalStackAlignState *state = GST_FOCAL_STACK_ALIGN(object)->state;
    if (id == property_stats)
        g_value_take_boxed(value, state->statistics.to_structure());
    else if (!dff::get_align_property(state->settings, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

void finalize(GObject *object)
{
    delete GST_FOCAL_STACK_ALIGN(object)->state;
    G_OBJECT_CLASS(gst_focal_stack_align_parent_class)->finalize(object);
}

void install_properties(GObjectClass *object_class)
{
    dff::install_align_properties(object_class);
    /**
     * GstFocalStackAlign:stats:
     *
     * "stacks" (uint64) were aligned, and in them "untrusted-planes" (uint64) could not be matched.
     * "bad-pixels" (uint64) of the sensor are left out of the last one. "planes"
     * is an array with a structure for each plane of the last stack, nearest first, that says where the
     * picture of the middle plane lies in it: "dx" and "dy" (double), the shift of the centre in pixels,
     * right and down; "scale" (double), the zoom about the centre; "rotation" (double), degrees clockwise;
     * "matrix" (array of 9 doubles), the whole homography row by row, on pixels from the centre; "trusted"
     * (boolean), whether this was found in the pictures; "blank" (boolean), whether it was not because there
     * is nothing in the plane that could be matched.
     */
    g_object_class_install_property(
        object_class, property_stats,
        g_param_spec_boxed(
            "stats", "Statistics",
            "Stacks aligned, planes not trusted, bad pixels, and for each plane of the last stack dx and "
            "dy (pixels), scale, rotation (degrees), the matrix and whether they are trusted",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

} // namespace

static void gst_focal_stack_align_class_init(GstFocalStackAlignClass *klass)
{
    GObjectClass *object_class = G_OBJECT_CLASS(klass);
    GstElementClass *element_class = GST_ELEMENT_CLASS(klass);
    GstBaseTransformClass *base_class = GST_BASE_TRANSFORM_CLASS(klass);

    GST_DEBUG_CATEGORY_INIT(focalstackalign_debug, "focalstackalign", 0, "Alignment of focal stacks");
    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_properties(object_class);

    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &source_template);
    gst_element_class_set_static_metadata(
        element_class, "Focal stack aligner", "Filter/Effect/Video",
        "Undoes focus breathing, vibration and a hand's shake within each focal stack",
        "The gst-plugins-dff authors");

    base_class->start = start;
    base_class->stop = stop;
    base_class->set_caps = set_caps;
    base_class->sink_event = sink_event;
    base_class->query = query;
    base_class->decide_allocation = decide_allocation;
    base_class->propose_allocation = propose_allocation;
    base_class->prepare_output_buffer = prepare_output_buffer;
    base_class->transform_meta = transform_meta;
    base_class->transform = transform;
}

static void gst_focal_stack_align_init(GstFocalStackAlign *self)
{
    self->state = new FocalStackAlignState;
}
