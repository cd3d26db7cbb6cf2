/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "stack_depth.h"

#include "gstcl/mapped_stack.h"

#include <algorithm>
#include <system_error>

namespace dff {

namespace {

void set_intrinsics(GstDepthInfo &depth, const CameraCalibration &camera)
{
    depth.has_intrinsics = TRUE;
    depth.fx = camera.fx;
    depth.fy = camera.fy;
    depth.cx = camera.cx;
    depth.cy = camera.cy;
    std::copy(camera.distortion.begin(), camera.distortion.end(), depth.distortion);
}

} // namespace

void StackDepth::stop()
{
    engine_.reset();
    coming_engine_ = {};
    device_.reset();
}

void StackDepth::set_stack(const GstFocalStackInfo &stack)
{
    FocusEngine::require_room(*device_, stack_shape(stack), settings_.parameters);
    stack_ = stack;
    engine_.reset();
    coming_engine_ = {};
    try {
        coming_engine_ = std::async(std::launch::async, [device = device_, shape = stack_shape(stack_),
                                                         parameters = settings_.parameters] {
            return std::make_unique<FocusEngine>(device, shape, parameters);
        });
    } catch (const std::system_error &) {
        /* No thread is to be had: prepare() makes the engine. */
    }
}

void StackDepth::set_settings(const DepthSettings &settings)
{
    settings_ = settings;
    engine_.reset();
    coming_engine_ = {};
}

void StackDepth::prepare()
{
    if (engine_)
        return;
    translate_errors(*device_, [&] {
        engine_ = coming_engine_.valid()
                      ? coming_engine_.get()
                      : std::make_unique<FocusEngine>(device_, stack_shape(stack_), settings_.parameters);
    });
    encoder_.reset();
}

std::optional<std::string> StackDepth::take_positions(GstBuffer *stack)
{
    try {
        PlanePositions positions = plane_positions(stack_, stack);
        if (encoder_ && positions == positions_)
            return std::nullopt;
        encoder_ = make_encoder(settings_.unit, stack_.planes, positions);
        positions_ = std::move(positions);
        engine_->set_encoder(*encoder_);
        return std::nullopt;
    } catch (const UnknownPositions &error) {
        if (!encoder_)
            throw;
        return error.what();
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
}

GstDepthInfo StackDepth::facts(GstBuffer *stack, guint64 index) const
{
    GstDepthInfo depth =
        encoder_ ? depth_info(*encoder_, positions_) : depth_info(DepthEncoder::index(stack_.planes), {});
    depth.sequence = index;
    if (const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack)) {
        GstFocusInfo focus;
        gst_focal_stack_meta_get_focus(meta, 0, &focus);
        depth.sequence = meta->sequence;
        depth.sweep = focus.sweep;
    }
    if (calibration_)
        set_intrinsics(depth,
                       calibration_->scaled_to(static_cast<unsigned>(GST_VIDEO_INFO_WIDTH(&stack_.frame)),
                                               static_cast<unsigned>(GST_VIDEO_INFO_HEIGHT(&stack_.frame))));
    return depth;
}

} // namespace dff
