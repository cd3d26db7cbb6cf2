/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-focalstackdenoise
 *
 * Averages each plane of a focal stack with the same plane of the sweeps before, as long as nothing moved
 * there: for cameras in the dark, whose frames are as short as the sweep allows. Depth and all-in-focus
 * pictures behind it become less noisy and steadier; with 8 sweeps the noise falls to about a third.
 *
 * Tiles of 8x8 pixels in which something moved, and those around them, show the last sweep alone; a cut, a
 * light that is switched, a camera that pans show no ghost. What is motion and what is noise is decided by
 * the noise of the sensor, as a curve over brightness that the element finds in the pictures themselves and
 * tells in `stats`. Planes that were lost or repeat another's picture are left as they are.
 *
 * Pixels of the sensor that are too bright or too dark in all planes, whatever is before them, hot and dead
 * ones, become the median of their neighbours before anything else. They are known after three parts of the
 * scene have come before them, for while nothing moves they may be the scene's own, and in sweeps of five
 * planes or more.
 *
 * The noise that is left goes with each stack whose planes have it alike, from the second one on: a
 * GstCustomMeta by the name GstFocalStackNoiseMeta, whose field "luma" (double) is the standard deviation of
 * luma where white is 255. dffdepth and aifcompose believe it.
 *
 * A sweep takes time, and what moves meanwhile is in another place in each plane: depth and picture have
 * ghosts around it. With `local-motion` each plane is changed to what it would show in the middle of the
 * sweep, (planes - 1) / 2 planes after the first one: objects are followed along their path, and what they
 * cover in a plane is filled with the background of the sweeps before. It needs a camera that stands still,
 * two sweeps to know the background, and five planes or more, taken in their order; where nothing moves, not
 * a bit changes by it.
 *
 * A hand that shakes moves everything: with focalstackalign before it, which tells where each stack lies, the
 * same places of the scene are averaged; nothing is followed by `local-motion` from a sweep to another then
 * that lies 2 pixels away or more. The stack is changed in place where nobody else holds it. Each format of
 * stacks will do, rolling windows too; one with the flag GAP, which shows nothing, passes as it is.
 *
 * ## Example pipeline
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 noise=strong ! focalstackmux ! queue ! \
 *     focalstackdenoise ! queue ! dffdepth ! fakesink
 * ]| computes depth of a noisy camera from the mean of up to 8 sweeps.
 */
#include "focalstack/focalstackdenoise_private.h"

#include "common/stack_place.h"
#include "gstcl/engine_caps.h"
#include "gstcl/engine_message.h"

#include <cmath>
#include <gst/dff/dff.h>

GST_DEBUG_CATEGORY(focalstackdenoise_debug);

namespace {

constexpr guint property_stats = dff::denoise_properties_end;

GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(ENGINE_STACK_CAPS));
GstStaticPadTemplate source_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(ENGINE_STACK_CAPS));

} // namespace

G_DEFINE_FINAL_TYPE(GstFocalStackDenoise, gst_focal_stack_denoise, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE(focalstackdenoise, "focalstackdenoise", GST_RANK_NONE,
                            GST_TYPE_FOCAL_STACK_DENOISE)

namespace {

gboolean set_caps(GstBaseTransform *base, GstCaps *caps, GstCaps *)
{
    GstFocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
    GstFocalStackInfo info;

    if (!gst_focal_stack_info_from_caps(&info, caps))
        return FALSE;
    if (const auto problem = dff::wrong_size(info.frame)) {
        GST_ELEMENT_ERROR(base, STREAM, FORMAT, ("%s", problem->c_str()), (nullptr));
        return FALSE;
    }
    state.info = info;
    state.denoiser.reset();
    state.follower.reset();
    state.bad_pixels.forget();
    state.place.reset();
    return TRUE;
}

/* focalstackalign is asked where each stack lies. */
gboolean propose_allocation(GstBaseTransform *base, GstQuery *decide_query, GstQuery *query)
{
    const GstBaseTransformClass *parent = GST_BASE_TRANSFORM_CLASS(gst_focal_stack_denoise_parent_class);
    const gboolean proposed = parent->propose_allocation(base, decide_query, query);
    gst_query_add_allocation_meta(query, dff::stack_place_meta_api(), nullptr);
    return proposed;
}

gboolean sink_event(GstBaseTransform *base, GstEvent *event)
{
    GstFocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP && state.denoiser) {
        state.denoiser->forget();
        state.follower.reset();
        const std::lock_guard lock(state.mutex);
        state.report = {};
    }
    return GST_BASE_TRANSFORM_CLASS(gst_focal_stack_denoise_parent_class)->sink_event(base, event);
}

gboolean query(GstBaseTransform *base, GstPadDirection direction, GstQuery *query)
{
    GstFocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
    if (state.context.answer(query))
        return TRUE;
    const gboolean answered =
        GST_BASE_TRANSFORM_CLASS(gst_focal_stack_denoise_parent_class)->query(base, direction, query);
    if (!answered || direction != GST_PAD_SRC || GST_QUERY_TYPE(query) != GST_QUERY_LATENCY)
        return answered;

    gboolean live = FALSE;
    GstClockTime least = 0, most = GST_CLOCK_TIME_NONE;
    gst_query_parse_latency(query, &live, &least, &most);
    const std::lock_guard lock(state.mutex);
    const GstClockTime own = state.latency.get();
    gst_query_set_latency(query, live, least + own, GST_CLOCK_TIME_IS_VALID(most) ? most + own : most);
    return TRUE;
}

gboolean start(GstBaseTransform *base)
{
    GstFocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
    std::string wish;
    {
        const std::lock_guard lock(state.mutex);
        wish = state.settings.device;
        state.stacks = 0;
        state.report = {};
        state.moved = 0.0;
        state.bad_pixel_count = 0;
        state.latency.reset();
    }
    try {
        state.device = state.context.open(wish);
        return TRUE;
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(base), error);
        return FALSE;
    }
}

gboolean stop(GstBaseTransform *base)
{
    GstFocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
    state.denoiser.reset();
    state.follower.reset();
    state.info.reset();
    state.device.reset();
    state.context.close();
    return TRUE;
}

/* Standard deviations of the first component's samples, of 256 brightnesses. */
void set_noise(GstStructure *stats, const dff::DenoiseReport &report)
{
    GValue curve = G_VALUE_INIT;
    gst_value_array_init(&curve, 0);
    if (!report.noise.empty()) {
        for (const float variance : report.noise.front()) {
            GValue value = G_VALUE_INIT;
            g_value_init(&value, G_TYPE_DOUBLE);
            g_value_set_double(&value, std::sqrt(static_cast<double>(variance)) * report.sample_unit);
            gst_value_array_append_and_take_value(&curve, &value);
        }
    }
    gst_structure_take_value(stats, "noise", &curve);
}

GstStructure *statistics(GstFocalStackDenoiseState &state)
{
    const std::lock_guard lock(state.mutex);
    GstStructure *stats =
        gst_structure_new("application/x-focalstackdenoise-stats", "stacks", G_TYPE_UINT64, state.stacks,
                          "sweeps", G_TYPE_DOUBLE, state.report.mean_sweeps, "moved", G_TYPE_DOUBLE,
                          state.moved, "bad-pixels", G_TYPE_UINT64, state.bad_pixel_count, nullptr);
    if (state.report.left)
        gst_structure_set(stats, "noise-left", G_TYPE_DOUBLE, *state.report.left, nullptr);
    set_noise(stats, state.report);
    return stats;
}

void set_property(GObject *object, guint id, const GValue *value, GParamSpec *spec)
{
    GstFocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(object)->state;
    bool is_known = false, is_idle = false;
    {
        const std::lock_guard lock(state.mutex);
        is_known = dff::set_denoise_property(state.settings, id, value);
        is_idle = state.settings.ask_for_nothing();
    }
    if (!is_known)
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
    gst_base_transform_set_passthrough(GST_BASE_TRANSFORM(object), is_idle);
}

void get_property(GObject *object, guint id, GValue *value, GParamSpec *spec)
{
    GstFocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(object)->state;
    if (id == property_stats) {
        g_value_take_boxed(value, statistics(state));
        return;
    }
    const std::lock_guard lock(state.mutex);
    if (!dff::get_denoise_property(state.settings, id, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

void finalize(GObject *object)
{
    delete GST_FOCAL_STACK_DENOISE(object)->state;
    G_OBJECT_CLASS(gst_focal_stack_denoise_parent_class)->finalize(object);
}

void install_properties(GObjectClass *object_class)
{
    dff::install_denoise_properties(object_class);
    /**
     * GstFocalStackDenoise:stats:
     *
     * "stacks" (uint64) were denoised, or followed; in the last one, "sweeps" (double) were averaged, as a
     * mean over the picture, and "moved" (double, 0 to 1) is the part of it in which local-motion saw
     * anything. "bad-pixels" (uint64) of the sensor are left out. "noise" is an array of 16 doubles: the
     * standard deviation of the noise of a single frame at 16 brightnesses from black to white, in units of
     * which white has 256.
     */
    g_object_class_install_property(
        object_class, property_stats,
        g_param_spec_boxed("stats", "Statistics",
                           "Stacks denoised, sweeps averaged and part that moved in the last one, bad "
                           "pixels of the sensor, noise "
                           "(standard deviation, white is 256) at 16 brightnesses, and noise-left in luma",
                           GST_TYPE_STRUCTURE,
                           static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

} // namespace

static void gst_focal_stack_denoise_class_init(GstFocalStackDenoiseClass *klass)
{
    GObjectClass *object_class = G_OBJECT_CLASS(klass);
    GstElementClass *element_class = GST_ELEMENT_CLASS(klass);
    GstBaseTransformClass *base_class = GST_BASE_TRANSFORM_CLASS(klass);

    GST_DEBUG_CATEGORY_INIT(focalstackdenoise_debug, "focalstackdenoise", 0, "Denoising of focal stacks");
    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_properties(object_class);

    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &source_template);
    gst_element_class_set_static_metadata(
        element_class, "Focal stack denoiser", "Filter/Effect/Video",
        "Averages each plane with the same plane of the sweeps before where nothing moved",
        "The gst-plugins-dff authors");

    base_class->start = start;
    base_class->stop = stop;
    base_class->set_caps = set_caps;
    base_class->sink_event = sink_event;
    base_class->query = query;
    base_class->propose_allocation = propose_allocation;
    base_class->transform_ip = gst_focal_stack_denoise_transform_ip;
    base_class->transform_ip_on_passthrough = FALSE;
}

static void gst_focal_stack_denoise_init(GstFocalStackDenoise *self)
{
    self->state = new GstFocalStackDenoiseState(GST_ELEMENT(self));
    gst_base_transform_set_in_place(GST_BASE_TRANSFORM(self), TRUE);
    gst_base_transform_set_gap_aware(GST_BASE_TRANSFORM(self), TRUE);
}
