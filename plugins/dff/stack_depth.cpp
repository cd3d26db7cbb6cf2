/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "stack_depth.h"

#include "gstcl/mapped_stack.h"

#include <algorithm>
#include <cstdlib>
#include <span>
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

/* Half of the way from plane to plane, at each depth. */
DepthJumps jumps_of(const DepthEncoder &encoder)
{
    DepthJumps jumps{};
    for (size_t i = 0; i < jumps.size(); i++) {
        const auto z = encoder.decode(static_cast<uint16_t>(i * jumps.size() + jumps.size() / 2));
        const int way = z ? std::abs(encoder.encode(*z + 0.25) - encoder.encode(*z - 0.25)) : 1;
        jumps[i] = static_cast<uint16_t>(std::max(way, 1));
    }
    return jumps;
}

} // namespace

void StackDepth::stop()
{
    steady_.reset();
    engine_.reset();
    coming_engine_ = {};
    device_.reset();
}

void StackDepth::set_stack(const GstFocalStackInfo &stack)
{
    FocusEngine::require_room(*device_, stack_shape(stack), settings_.parameters);
    stack_ = stack;
    steady_.reset();
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
    steady_.reset();
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

PlanePositions StackDepth::positions_of(GstBuffer *stack) const
{
    PlanePositions positions = plane_positions(stack_, stack);
    if (!focus_)
        return positions;
    if (focus_->vergences.size() != stack_.planes)
        throw UnknownPositions("The calibration has " + std::to_string(focus_->vergences.size()) +
                               " planes and the stack " + std::to_string(stack_.planes) +
                               ": make one of this sweep with dff-calibrate");
    positions.powers = focus_->vergences;
    return positions;
}

DepthEncoder StackDepth::flat_encoder(const PlanePositions &positions)
{
    field_.reset();
    DepthEncoder encoder = make_encoder(settings_.unit, stack_.planes, positions);
    const DepthUnit unit = encoder.scale().unit;
    if (!focus_ || focus_->is_flat() || (unit != DepthUnit::Dioptre && unit != DepthUnit::Millimetre))
        return encoder;
    field_.emplace(*focus_, static_cast<unsigned>(GST_VIDEO_INFO_WIDTH(&stack_.frame)),
                   static_cast<unsigned>(GST_VIDEO_INFO_HEIGHT(&stack_.frame)), unit);
    return make_encoder(GST_DEPTH_UNIT_DIOPTRE, stack_.planes, positions);
}

std::optional<std::string> StackDepth::take_positions(GstBuffer *stack)
{
    try {
        PlanePositions positions = positions_of(stack);
        if (encoder_ && positions == positions_)
            return std::nullopt;
        steady_.reset();
        encoder_ = flat_encoder(positions);
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

bool StackDepth::compute(const StackView &view, const DepthOutputs &outputs)
{
    DepthOutputs all = outputs;
    if (field_ && outputs.uncertainty.pixels && !outputs.depth.pixels) {
        unseen_depth_.resize(size_t{view.shape.width} * view.shape.height);
        all.depth = {std::as_writable_bytes(std::span(unseen_depth_)).data(),
                     view.shape.width * sizeof(uint16_t)};
    }
    if (!engine_->compute(view, all))
        return false;
    keep_steady(view, all.depth);
    if (field_)
        bend(all);
    return true;
}

void StackDepth::bend(const DepthOutputs &outputs)
{
    for (const OutputPicture &map : {outputs.depth, outputs.sparse})
        if (map.pixels)
            field_->apply(map.pixels, map.stride);
    if (outputs.uncertainty.pixels)
        field_->apply_to_deviations(outputs.uncertainty.pixels, outputs.uncertainty.stride,
                                    outputs.depth.pixels, outputs.depth.stride);
}

void StackDepth::keep_steady(const StackView &view, const OutputPicture &depth)
{
    const bool is_wanted =
        settings_.steady == Steadiness::On || (settings_.steady == Steadiness::Auto && is_live_);
    if (!is_wanted || !depth.pixels) {
        steady_.reset();
        return;
    }
    if (!steady_) {
        steady_.emplace(view.shape);
        jumps_ = jumps_of(*encoder_);
    }
    steady_->steady(view, {depth.pixels, depth.stride}, jumps_);
}

GstDepthInfo StackDepth::facts(GstBuffer *stack, guint64 index) const
{
    GstDepthInfo depth =
        encoder_ ? depth_info(*encoder_, positions_) : depth_info(DepthEncoder::index(stack_.planes), {});
    if (encoder_ && field_) {
        depth.unit =
            field_->scale().unit == DepthUnit::Dioptre ? GST_DEPTH_UNIT_DIOPTRE : GST_DEPTH_UNIT_MILLIMETRE;
        depth.scale = field_->scale().scale;
        depth.offset = field_->scale().offset;
        depth.near = field_->near();
        depth.far = field_->far();
    }
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
