/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/focalstackdenoise_private.h"

#include "common/stack_noise.h"
#include "gstcl/engine_message.h"
#include "gstcl/mapped_stack.h"
#include "gstcl/start_progress.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

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
    GstFocalStackDenoiseState &state = *self->state;
    if (state.denoiser)
        return;
    state.denoiser = std::make_unique<dff::StackDenoiser>(state.device, dff::stack_shape(*state.info));
    GST_INFO_OBJECT(self, "denoising %ux%u stacks of %u planes on %s",
                    GST_VIDEO_INFO_WIDTH(&state.info->frame), GST_VIDEO_INFO_HEIGHT(&state.info->frame),
                    state.info->planes, state.device->name().c_str());
}

void account(GstFocalStackDenoise *self, dff::DenoiseReport report, GstClockTime compute_time, bool is_first)
{
    GstFocalStackDenoiseState &state = *self->state;
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

Wishes wishes(GstFocalStackDenoiseState &state)
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

/* Nothing is followed in sweeps of few planes, nor in rolling windows, whose planes are of two sweeps; what
 * stands behind is learned anew after them. Nor is a sweep with planes that do not show what they should. */
void denoise_stack(GstFocalStackDenoiseState &state, const WritableStack &stack, guint64 absent)
{
    const Wishes wanted = wishes(state);
    const dff::StackView &view = stack.view();
    const bool has_few = view.shape.planes < dff::SweepFollower::fewest_planes;
    if (!wanted.settings.local_motion || has_few || !is_one_sweep(view)) {
        state.follower.reset();
        state.denoiser->denoise(view, stack.memory(), absent, wanted.settings.parameters);
        return;
    }
    if (!state.follower)
        state.follower = std::make_unique<dff::SweepFollower>(view.shape);
    const std::span<const uint8_t> held = state.follower->look(view, stack.memory(), wanted.report, absent);
    state.denoiser->denoise(view, stack.memory(), absent, wanted.settings.parameters, held);
    if (absent == 0)
        state.follower->follow(view, stack.memory(), *state.denoiser);
}

/* What is known goes along with a camera that shakes. Motion is followed where it rests. */
void follow_place(GstFocalStackDenoiseState &state, const std::optional<dff::StackPlace> &place)
{
    const auto before = std::exchange(state.place, place);
    if (!place || !before || place->anchor != before->anchor || *place == *before)
        return;
    state.denoiser->shift(place->right - before->right, place->down - before->down);
    state.follower.reset();
}

void denoise(GstFocalStackDenoise *self, GstBuffer *buffer)
{
    GstFocalStackDenoiseState &state = *self->state;
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

} // namespace

GstFlowReturn gst_focal_stack_denoise_transform_ip(GstBaseTransform *base, GstBuffer *buffer)
{
    GstFocalStackDenoise *self = GST_FOCAL_STACK_DENOISE(base);
    if (GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP)) /* of which nothing can be learned */
        return GST_FLOW_OK;
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
