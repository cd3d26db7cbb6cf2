/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depth_output.h"
#include "engine/focus_engine.h"

#include <functional>
#include <memory>
#include <vector>

namespace dff {

/* The pictures that one stack gives: one for each output that is linked. */
class DepthMaps {
public:
    /* Prepares the linked outputs and takes a picture of the stack's size from each. */
    DepthMaps(const std::vector<std::shared_ptr<DepthOutput>> &outputs, const GstVideoInfo &stack,
              const GstDepthInfo &depth, const StreamSegment &segment);
    ~DepthMaps();

    DepthMaps(const DepthMaps &) = delete;
    DepthMaps &operator=(const DepthMaps &) = delete;

    /* Where the engine writes. */
    DepthOutputs outputs() const;

    /* Nothing could be told: all 0, with the flags GAP and CORRUPTED. */
    void blank();

    /* Gives the pictures the time of `stack`, the `index`-th of its stream; without a time of its own that is
     * index / framerate. */
    void stamp(GstBuffer *stack, guint64 index);

    /* Pushes each picture and tells `pushed` what came of it. */
    void push(const std::function<void(GstPad *, GstFlowReturn)> &pushed);

private:
    struct Map {
        std::shared_ptr<DepthOutput> output;
        GstBuffer *buffer;
        GstVideoFrame frame;
    };

    GstVideoInfo stack_;
    std::vector<Map> maps_;
};

} // namespace dff
