/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "dffdepth_private.h"
#include "gstcl/engine_message.h"
#include "gstcl/mapped_stack.h"
#include "gstcl/start_progress.h"

#include <gst/dff/dff.h>
#include <utility>

std::optional<dff::DepthSettings> gst_dff_depth_changed_settings(GstDffDepthState &state)
{
    const std::lock_guard lock(state.mutex);
    if (!state.settings_changed)
        return std::nullopt;
    state.settings_changed = false;
    return state.settings;
}

/* Counts a stack, and announces the latency if it has grown. */
static void account(GstDffDepth *self, GstClockTime compute_time, bool is_first, bool known)
{
    GstDffDepthState &state = *self->state;
    bool has_grown = false;
    {
        const std::lock_guard lock(state.mutex);
        state.statistics.add(state.depth, known, compute_time);
        has_grown = state.latency.add(compute_time, is_first);
    }
    if (has_grown)
        gst_element_post_message(GST_ELEMENT(self), gst_message_new_latency(GST_OBJECT(self)));
}

/* A cause is told once, however many stacks it costs. */
static bool is_news(GstDffDepthState &state, const std::string &warning)
{
    return std::exchange(state.last_warning, warning) != warning;
}

static void look_for_peaks(GstDffDepth *self, const dff::StackShape &shape,
                           const dff::OutputPicture &confidence)
{
    GstDffDepthState &state = *self->state;
    if (dff::PeakWatch::has_peaks(confidence.pixels, confidence.stride, shape.width, shape.height))
        return;
    GST_WARNING_OBJECT(self, "no pixel of stack %" G_GUINT64_FORMAT " is sharper in one plane",
                       state.next_stack);
    if (!std::exchange(state.told_of_no_peaks, true))
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("All planes are equally sharp, everywhere in the picture: the depth says nothing. Look whether "
             "the lens moves, whether the picture shows anything, and whether each frame is of the plane it "
             "is said to be"),
            (nullptr));
}

/* Returns false where nothing can be told of the stack. */
static bool compute(GstDffDepth *self, const dff::StackView &view, GstBuffer *stack, dff::DepthMaps &maps)
{
    if (GST_BUFFER_FLAG_IS_SET(stack, GST_BUFFER_FLAG_GAP))
        return false;
    GstDffDepthState &state = *self->state;
    try {
        dff::DepthOutputs outputs = maps.outputs();
        const bool is_due = state.peaks.is_due();
        if (is_due && !outputs.confidence.pixels)
            outputs.confidence = {state.peaks.room(size_t{view.shape.width} * view.shape.height).data(),
                                  view.shape.width};
        if (outputs.uncertainty.pixels && !state.depth.tells_uncertainty() &&
            !std::exchange(state.told_of_no_uncertainty, true))
            GST_ELEMENT_WARNING(
                self, STREAM, NOT_IMPLEMENTED,
                ("method=paper does not tell how uncertain depth is, and the pad uncertainty gives 0: "
                 "use method=volume"),
                (nullptr));
        const bool known = state.depth.compute(view, outputs);
        if (is_due)
            look_for_peaks(self, view.shape, outputs.confidence);
        return known;
    } catch (const dff::EngineError &error) {
        GST_WARNING_OBJECT(self, "%s", error.what());
        if (is_news(state, error.what()))
            dff::post_engine_warning(GST_ELEMENT(self), error);
        return false;
    }
}

/* Returns false, and says why, if the stack says of its planes what cannot be. */
static bool take_positions(GstDffDepth *self, GstBuffer *stack)
{
    GstDffDepthState &state = *self->state;
    const auto problem = state.depth.take_positions(stack);
    if (!problem)
        return true;
    GST_WARNING_OBJECT(self, "no depth of %" GST_PTR_FORMAT ": %s", stack, problem->c_str());
    if (is_news(state, *problem))
        GST_ELEMENT_WARNING(self, STREAM, FORMAT, ("A stack has no depth: %s", problem->c_str()),
                            ("Its depth map is all 0, with the flags GAP and CORRUPTED."));
    return false;
}

GstFlowReturn gst_dff_depth_chain(GstPad *, GstObject *parent, GstBuffer *buffer)
{
    GstDffDepth *self = GST_DFF_DEPTH(parent);
    GstDffDepthState &state = *self->state;
    g_autoptr(GstBuffer) stack = buffer;

    GST_LOG_OBJECT(self, "stack %" G_GUINT64_FORMAT ": %" GST_PTR_FORMAT, state.next_stack, stack);
    if (!state.has_caps) {
        GST_ELEMENT_ERROR(self, CORE, NEGOTIATION,
                          ("A stack came before its caps: put a capsfilter with " GST_FOCAL_STACK_CAPS_NAME
                           ", format, width, height, planes and framerate before dffdepth"),
                          (nullptr));
        return GST_FLOW_NOT_NEGOTIATED;
    }
    try {
        const dff::MappedStack mapped(state.depth.stack(), stack, state.depth.device());
        if (const auto settings = gst_dff_depth_changed_settings(state)) {
            GST_DEBUG_OBJECT(self, "new settings from stack %" G_GUINT64_FORMAT " on", state.next_stack);
            state.depth.set_settings(*settings);
        }
        const bool is_first = state.depth.is_at_start();
        std::optional<dff::StartProgress> progress;
        if (is_first)
            progress.emplace(GST_ELEMENT(self));
        const GstClockTime asked = gst_util_get_timestamp();
        state.depth.prepare();
        if (is_first)
            GST_INFO_OBJECT(self, "the kernels were waited for %" GST_TIME_FORMAT,
                            GST_TIME_ARGS(gst_util_get_timestamp() - asked));
        const bool has_positions = take_positions(self, stack);
        const GstDepthInfo depth = state.depth.facts(stack, state.next_stack);
        dff::DepthMaps maps(state.outputs.outputs(), state.depth.stack().frame, depth, state.segment);

        const GstClockTime start = gst_util_get_timestamp();
        const bool known = has_positions && compute(self, mapped.view(), stack, maps);
        progress.reset();
        if (!known)
            maps.blank();
        maps.stamp(
            stack,
            state.clock.next(state.depth.stack().frame, GST_BUFFER_PTS(stack), GST_BUFFER_DURATION(stack)),
            state.next_stack);
        if (const float blur_step = state.depth.blur_step(); known && blur_step > 0.0f) {
            GST_DEBUG_OBJECT(self, "stack %" G_GUINT64_FORMAT ": %.2f px of blur a plane", state.next_stack,
                             blur_step);
            maps.add_blur_step(blur_step);
        }
        account(self, gst_util_get_timestamp() - start, is_first, known);
        GST_DEBUG_OBJECT(self, "stack %" G_GUINT64_FORMAT " (number %" G_GUINT64_FORMAT ") %s",
                         state.next_stack, depth.sequence, known ? "has depth" : "has no depth");
        state.next_stack++;
        return state.outputs.push(maps);
    } catch (const dff::EngineError &error) {
        dff::post_engine_error(GST_ELEMENT(self), error);
    } catch (const std::invalid_argument &error) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s", error.what()), (nullptr));
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(self, STREAM, DECODE, ("%s", error.what()), (nullptr));
    }
    return GST_FLOW_ERROR;
}
