/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "dffdepth_properties.h"
#include "engine/steady_depth.h"
#include "gstcl/depth_facts.h"
#include "optics/camera_calibration.h"
#include "optics/curved_field.h"

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dff {

/* The engine of dffdepth, made anew where caps, settings or the planes' positions change. Used by one thread.
 */
class StackDepth {
public:
    void start(std::shared_ptr<Device> device) { device_ = std::move(device); }
    void stop();
    const Device &device() const { return *device_; }

    /* Settings of what comes from here on. */
    void set_settings(const DepthSettings &settings);

    /* Caps of what comes from here on. Their engine is made in a thread of its own, while the frames of the
     * first stack still arrive: kernels take their time to be loaded, which a live source must not feel.
     * Throws EngineError if the device has no room for them. */
    void set_stack(const GstFocalStackInfo &stack);
    /* What the facts say of the camera, and where its planes are sharp, if that is known better than by the
     * stacks. */
    void set_calibration(std::optional<CameraCalibration> calibration, std::optional<FocusCalibration> focus)
    {
        calibration_ = calibration;
        focus_ = std::move(focus);
    }
    const GstFocalStackInfo &stack() const { return stack_; }

    /* Whether the next stack to be computed is the first one of its engine. */
    bool is_at_start() const { return times().empty(); }

    /* Makes the engine. Throws EngineError. */
    void prepare();

    /* Makes the engine ready for where the planes of `stack` lie. Returns what keeps it from it, in a user's
     * words: the stack then has no depth. Throws UnknownPositions if the unit needs what no stack has said
     * yet.
     */
    std::optional<std::string> take_positions(GstBuffer *stack);

    /* The facts of the depth map of `stack`, the `index`-th of its stream; of planes as they lay last. */
    GstDepthInfo facts(GstBuffer *stack, guint64 index) const;

    /* FocusEngine::compute(), and the depth kept steady as the settings want it. */
    bool compute(const StackView &view, const DepthOutputs &outputs);

    bool tells_uncertainty() const { return FocusEngine::tells_uncertainty(settings_.parameters.method); }

    /* Where the stacks come from, for Steadiness::Auto. */
    void set_live(bool is_live) { is_live_ = is_live; }

    /* The next stack is of another time. */
    void forget() { steady_.reset(); }

    /* Of the last stack; empty before the first. */
    StageTimes times() const { return engine_ ? engine_->times() : StageTimes(); }
    float blur_step() const { return engine_ ? engine_->blur_step() : 0.0f; } /* FocusEngine::blur_step() */
    std::optional<float> residual() const { return engine_ ? engine_->residual() : std::nullopt; }

private:
    void bend(const DepthOutputs &outputs);
    void keep_steady(const StackView &view, const OutputPicture &depth);
    PlanePositions positions_of(GstBuffer *stack) const;
    DepthEncoder flat_encoder(const PlanePositions &positions);

    std::shared_ptr<Device> device_;
    DepthSettings settings_;
    GstFocalStackInfo stack_{};
    std::future<std::unique_ptr<FocusEngine>> coming_engine_; /* for stack_ and settings_ */
    std::unique_ptr<FocusEngine> engine_;
    std::optional<DepthEncoder> encoder_;
    PlanePositions positions_;
    std::optional<CameraCalibration> calibration_;
    std::optional<FocusCalibration> focus_;
    std::optional<CurvedField> field_;   /* of encoder_, which then is as if it were flat */
    std::vector<uint16_t> unseen_depth_; /* where only its uncertainty is wanted */
    std::optional<SteadyDepth> steady_;  /* while it is wanted */
    DepthJumps jumps_{};                 /* of encoder_ */
    bool is_live_ = false;
};

} // namespace dff
