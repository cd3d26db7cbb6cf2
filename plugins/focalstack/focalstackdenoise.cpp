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
 * stacks will do, rolling windows too.
 *
 * ## Example pipeline
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 noise=strong ! focalstackmux ! queue ! \
 *     focalstackdenoise ! queue ! dffdepth ! fakesink
 * ]| computes depth of a noisy camera from the mean of up to 8 sweeps.
 */
#include "focalstack/focalstackdenoise.h"

#include "common/stack_noise.h"
#include "common/stack_place.h"
#include "focalstack/bad_pixels.h"
#include "focalstack/focalstackdenoise_properties.h"
#include "focalstack/sweep_follower.h"
#include "gstcl/compute_latency.h"
#include "gstcl/device_context.h"
#include "gstcl/engine_caps.h"
#include "gstcl/engine_message.h"
#include "gstcl/mapped_stack.h"
#include "gstcl/start_progress.h"

#include <algorithm>
#include <cmath>
#include <gst/dff/dff.h>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

GST_DEBUG_CATEGORY_STATIC(focalstackdenoise_debug);
#define GST_CAT_DEFAULT focalstackdenoise_debug

namespace {

struct FocalStackDenoiseState {
    explicit FocalStackDenoiseState(GstElement *element) : context(element) {}

    dff::DeviceContext context;

    /* The streaming thread's own. */
    std::shared_ptr<dff::Device> device;
    std::optional<GstFocalStackInfo> info;
    std::unique_ptr<dff::StackDenoiser> denoiser; /* for info; empty until the first stack of these caps */
    std::unique_ptr<dff::SweepFollower> follower; /* for info, while local-motion is wanted */
    dff::BadPixels bad_pixels;
    std::optional<dff::StackPlace> place; /* of the last stack, if focalstackalign told it */

    std::mutex mutex; /* guards what follows; nothing is locked under it */
    dff::DenoiseSettings settings;
    double moved = 0.0; /* part of the last stack */
    guint64 bad_pixel_count = 0;
    dff::DenoiseReport report;
    guint64 stacks = 0;
    dff::ComputeLatency latency;
};

constexpr guint property_stats = dff::denoise_properties_end;

GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(ENGINE_STACK_CAPS));
GstStaticPadTemplate source_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(ENGINE_STACK_CAPS));

} // namespace

struct _GstFocalStackDenoise {
    GstBaseTransform parent;
    FocalStackDenoiseState *state;
};

G_DEFINE_FINAL_TYPE(GstFocalStackDenoise, gst_focal_stack_denoise, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE(focalstackdenoise, "focalstackdenoise", GST_RANK_NONE,
                            GST_TYPE_FOCAL_STACK_DENOISE)

namespace {

/* Planes that do not show what they should. */
guint64 absent_planes(GstBuffer *stack)
{
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack);
    return meta ? meta->missing | meta->repeated : 0;
}

/* Maps for writing first: memory that somebody else holds is copied by that. */
class WritableStack {
public:
    WritableStack(const GstFocalStackInfo &info, GstBuffer *buffer, const dff::Device &device)
        : buffer_(buffer)
    {
        if (!gst_buffer_map(buffer, &map_, GST_MAP_READWRITE))
            throw std::runtime_error("The stack's memory cannot be written");
        try {
            stack_.emplace(info, buffer, device);
        } catch (...) {
            gst_buffer_unmap(buffer_, &map_);
            throw;
        }
    }
    ~WritableStack()
    {
        stack_.reset();
        gst_buffer_unmap(buffer_, &map_);
    }
    WritableStack(const WritableStack &) = delete;
    WritableStack &operator=(const WritableStack &) = delete;

    const dff::StackView &view() const { return stack_->view(); }
    std::span<std::byte> memory() const { return {reinterpret_cast<std::byte *>(map_.data), map_.size}; }

private:
    GstBuffer *buffer_;
    GstMapInfo map_{};
    std::optional<dff::MappedStack> stack_;
};

/* The first stack of these caps waits for its kernels. */
void ensure_denoiser(GstFocalStackDenoise *self)
{
    FocalStackDenoiseState &state = *self->state;
    if (state.denoiser)
        return;
    state.denoiser = std::make_unique<dff::StackDenoiser>(state.device, dff::stack_shape(*state.info));
    GST_INFO_OBJECT(self, "denoising %ux%u stacks of %u planes on %s",
                    GST_VIDEO_INFO_WIDTH(&state.info->frame), GST_VIDEO_INFO_HEIGHT(&state.info->frame),
                    state.info->planes, state.device->name().c_str());
}

void account(GstFocalStackDenoise *self, dff::DenoiseReport report, GstClockTime compute_time, bool is_first)
{
    FocalStackDenoiseState &state = *self->state;
    GST_DEBUG_OBJECT(self, "%.1f sweeps averaged, in %" GST_TIME_FORMAT, report.mean_sweeps,
                     GST_TIME_ARGS(compute_time));
    bool is_slower = false;
    {
        const std::lock_guard lock(state.mutex);
        state.report = std::move(report);
        state.moved = state.follower ? state.follower->moved() : 0.0;
        state.bad_pixel_count = state.bad_pixels.places().size();
        state.stacks++;
        is_slower = state.latency.add(compute_time, is_first);
    }
    if (is_slower)
        gst_element_post_message(GST_ELEMENT(self), gst_message_new_latency(GST_OBJECT(self)));
}

/* What the user wants of this stack, and what the one before told of noise. */
struct Wishes {
    dff::DenoiseSettings settings;
    dff::DenoiseReport report;
};

Wishes wishes(FocalStackDenoiseState &state)
{
    const std::lock_guard lock(state.mutex);
    return {state.settings, state.report};
}

/* All planes are known to be of one sweep, one after the other. */
bool is_one_sweep(const dff::StackView &view)
{
    const auto &planes = view.identities;
    return std::all_of(planes.begin(), planes.end(), [&](const auto &plane) {
        return !plane || !planes.front() || plane->sweep == planes.front()->sweep;
    });
}

/* Before anything else: what is sharp in all planes has no depth. */
void leave_out_bad_pixels(dff::BadPixels &known, const WritableStack &stack, guint64 absent)
{
    const auto pictures = dff::pictures_of(stack.view(), stack.memory());
    const auto components = stack.view().shape.components();
    std::vector<cv::Mat> taken;
    for (size_t z = 0; z < pictures.size(); z++)
        if (!(absent >> z & 1))
            taken.push_back(pictures[z].front());
    known.look(taken);
    for (const auto &plane : pictures)
        for (size_t c = 0; c < plane.size(); c++)
            dff::repair_pixels(plane[c], known.places(), static_cast<int>(components[c].subsampling));
}

/* Nothing is followed in sweeps of few planes, through planes that do not show what they should, nor in
 * rolling windows, whose planes are of two sweeps; what stands behind is learned anew after them. */
void denoise_stack(FocalStackDenoiseState &state, const WritableStack &stack, guint64 absent)
{
    const Wishes wanted = wishes(state);
    const dff::StackView &view = stack.view();
    const bool has_few = view.shape.planes < dff::SweepFollower::fewest_planes;
    if (!wanted.settings.local_motion || has_few || absent != 0 || !is_one_sweep(view)) {
        state.follower.reset();
        state.denoiser->denoise(view, stack.memory(), absent, wanted.settings.parameters);
        return;
    }
    if (!state.follower)
        state.follower = std::make_unique<dff::SweepFollower>(view.shape);
    const std::span<const uint8_t> held = state.follower->look(view, stack.memory(), wanted.report);
    state.denoiser->denoise(view, stack.memory(), absent, wanted.settings.parameters, held);
    state.follower->follow(view, stack.memory(), *state.denoiser);
}

/* What is known goes along with a camera that shakes. Motion is followed where it rests. */
void follow_place(FocalStackDenoiseState &state, const std::optional<dff::StackPlace> &place)
{
    const auto before = std::exchange(state.place, place);
    if (!place || !before || place->anchor != before->anchor || *place == *before)
        return;
    state.denoiser->shift(place->right - before->right, place->down - before->down);
    state.follower.reset();
}

void denoise(GstFocalStackDenoise *self, GstBuffer *buffer)
{
    FocalStackDenoiseState &state = *self->state;
    const gint64 start_us = g_get_monotonic_time();
    const bool is_first = !state.denoiser;
    std::optional<dff::StartProgress> progress;
    if (is_first)
        progress.emplace(GST_ELEMENT(self));
    ensure_denoiser(self);
    follow_place(state, dff::stack_place(buffer));
    const guint64 absent = absent_planes(buffer);
    {
        const WritableStack stack(*state.info, buffer, *state.device);
        leave_out_bad_pixels(state.bad_pixels, stack, absent);
        denoise_stack(state, stack, absent);
    }
    dff::DenoiseReport report = state.denoiser->report();
    /* Planes that are noisier than the others would pass for sharper ones. */
    dff::tell_stack_noise(buffer, absent == 0 ? report.left : std::nullopt);
    account(self, std::move(report),
            static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND, is_first);
}

GstFlowReturn transform_ip(GstBaseTransform *base, GstBuffer *buffer)
{
    GstFocalStackDenoise *self = GST_FOCAL_STACK_DENOISE(base);
    try {
        denoise(self, buffer);
        return GST_FLOW_OK;
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(self), error);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s", error.what()), (nullptr));
    }
    return GST_FLOW_ERROR;
}

gboolean set_caps(GstBaseTransform *base, GstCaps *caps, GstCaps *)
{
    FocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
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
    FocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
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
    FocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
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
    FocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
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
    FocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(base)->state;
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

GstStructure *statistics(FocalStackDenoiseState &state)
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
    FocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(object)->state;
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
    FocalStackDenoiseState &state = *GST_FOCAL_STACK_DENOISE(object)->state;
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
    base_class->transform_ip = transform_ip;
    base_class->transform_ip_on_passthrough = FALSE;
}

static void gst_focal_stack_denoise_init(GstFocalStackDenoise *self)
{
    self->state = new FocalStackDenoiseState(GST_ELEMENT(self));
    gst_base_transform_set_in_place(GST_BASE_TRANSFORM(self), TRUE);
}
