/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/aif_composer.h"
#include "gstcl/depth_facts.h"
#include "gstcl/picture_pool.h"

#include <gst/dff/dff.h>
#include <memory>
#include <optional>
#include <string>

namespace dff {

/* Stacks and depth maps in GstBuffers to all-in-focus pictures in GstBuffers. Used by one thread. */
class AifPicture {
public:
    void start(std::shared_ptr<Device> device) { device_ = std::move(device); }
    void stop();

    /* The caps of what comes from here on. */
    void set_stack(const GstFocalStackInfo &stack);
    /* `facts` hold for depth maps without a GstDepthMeta. */
    void set_depth(const GstVideoInfo &depth, const GstDepthInfo &facts);
    const GstFocalStackInfo &stack() const { return stack_; }

    /* Whether the depth map can be read, of planes as `stack` says that they lie: what keeps it from it, in a
     * user's words. compose() goes by the last one that was. */
    std::optional<std::string> take_facts(GstBuffer *stack, GstBuffer *depth);

    /* Returns a picture with the stack's time. Without a depth map it is the mean of the planes.
     * Throws EngineError, or std::exception with a user's text if depth and stack do not fit each other. */
    GstBuffer *compose(GstBuffer *stack, GstBuffer *depth, AifComposer::Blend blend);

private:
    void ensure_composer();
    void fill(GstBuffer *stack, GstBuffer *depth, AifComposer::Blend blend, GstBuffer *picture);

    std::shared_ptr<Device> device_;
    std::unique_ptr<AifComposer> composer_;
    std::optional<DepthEncoder> encoder_; /* of scale_ and positions_ */
    bool encoder_is_new_ = false;         /* the composer does not have it yet */
    GstDepthInfo scale_{};
    PlanePositions positions_;
    GstFocalStackInfo stack_{};
    GstVideoInfo depth_{};
    GstDepthInfo caps_facts_{};
    PicturePool pool_;
    std::vector<guint16> no_depth_; /* zeros, for stacks without a depth map */
    guint64 next_picture_ = 0;
};

} // namespace dff
