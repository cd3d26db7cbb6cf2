/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "common/stack_clock.h"
#include "depth_output.h"
#include "engine/focus_engine.h"

#include <functional>
#include <memory>
#include <vector>

namespace dff {

/* The pictures that one stack gives: one for each output that is linked. */
class DepthMaps {
public:
    /* Prepares the linked outputs and takes a picture of the stack's size from each. Throws
     * std::runtime_error with a user's text if there is no memory for one. */
    DepthMaps(const std::vector<std::shared_ptr<DepthOutput>> &outputs, const GstVideoInfo &stack,
              const GstDepthInfo &depth, const StreamSegment &segment);
    /* Where the engine writes. */
    DepthOutputs outputs() const;

    /* Nothing could be told: all 0, with the flags GAP and CORRUPTED. */
    void blank();

    /* Gives the pictures the time and the clock of `stack`, the `index`-th of its stream. */
    void stamp(GstBuffer *stack, const StackClock::Time &time, guint64 index);

    /* Tells the depth map's reader the stack's blur step, pixels a plane. */
    void add_blur_step(float pixels);

    /* Pushes each picture and tells `pushed` what came of it. */
    void push(const std::function<void(GstPad *, GstFlowReturn)> &pushed);

private:
    /* A picture of an output, mapped as long as this has it. */
    class Map {
    public:
        Map(std::shared_ptr<DepthOutput> output, const GstVideoInfo &stack);
        ~Map();

        Map(const Map &) = delete;
        Map &operator=(const Map &) = delete;

        const DepthOutput &output() const { return *output_; }
        GstBuffer *buffer() const { return buffer_; }
        OutputPicture picture() const;
        void blank();
        GstBuffer *release();

    private:
        std::shared_ptr<DepthOutput> output_;
        GstVideoInfo info_;
        GstBuffer *buffer_;
        GstMapInfo map_;
    };

    std::vector<std::unique_ptr<Map>> maps_;
};

} // namespace dff
