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
 * A stack without times gets those of its caps' frame rate. One with the flag GAP, which shows nothing, keeps
 * it and its planes where they are.
 *
 * ## Example pipeline
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 breathing=0.03 ! focalstackmux ! queue ! \
 *     focalstackalign ! queue ! dffdepth ! fakesink
 * ]| computes depth from sweeps whose planes differ in zoom by 3 percent.
 */
#include "focalstack/focalstackalign_private.h"

#include "common/stack_noise.h"
#include "common/stack_place.h"

#include <stdexcept>

GST_DEBUG_CATEGORY(focalstackalign_debug);

namespace {

constexpr guint property_stats = dff::align_properties_end;

GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_MAKE));
GstStaticPadTemplate source_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_MAKE));

} // namespace

G_DEFINE_FINAL_TYPE(GstFocalStackAlign, gst_focal_stack_align, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE(focalstackalign, "focalstackalign", GST_RANK_NONE, GST_TYPE_FOCAL_STACK_ALIGN)

namespace {

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
    const dff::ObjectLock lock(base);
    const GstClockTime own = GST_FOCAL_STACK_ALIGN(base)->state->latency;
    gst_query_set_latency(query, live, least + own, GST_CLOCK_TIME_IS_VALID(most) ? most + own : most);
    return TRUE;
}

gboolean load_calibration(GstFocalStackAlign *self)
{
    GstFocalStackAlignState *state = self->state;
    dff::AlignSettings settings;
    {
        const dff::ObjectLock lock(self);
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
    GstFocalStackAlignState *state = GST_FOCAL_STACK_ALIGN(base)->state;

    if (!load_calibration(GST_FOCAL_STACK_ALIGN(base)))
        return FALSE;
    const dff::ObjectLock lock(base);
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
    const dff::ObjectLock lock(object);
    if (!dff::set_align_property(GST_FOCAL_STACK_ALIGN(object)->state->settings, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

void get_property(GObject *object, guint id, GValue *value, GParamSpec *spec)
{
    const dff::ObjectLock lock(object);
    const GstFocalStackAlignState *state = GST_FOCAL_STACK_ALIGN(object)->state;
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
    base_class->transform = gst_focal_stack_align_transform;
}

static void gst_focal_stack_align_init(GstFocalStackAlign *self)
{
    self->state = new GstFocalStackAlignState;
    gst_base_transform_set_gap_aware(GST_BASE_TRANSFORM(self), TRUE);
}
