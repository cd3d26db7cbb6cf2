/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "captured_frame.h"
#include "gst_pointer.h"

#include <atomic>
#include <functional>
#include <map>
#include <set>
#include <string>

namespace dff {

/* The pipeline in front of the server: a capture, see gst_dff_capture_new(), of whose outputs it gives out
 * depth, uncertainty, aif and planes. It runs by the system clock, so that times compare with those of other
 * pipelines. */
class SourcePipeline {
public:
    using OnFrame =
        std::function<void(const std::string &output, const CapturedFrame &frame)>; /* any thread */
    using OnEnd = std::function<void(const std::string &reason)>; /* the thread that runs `context` */

    /* Throws std::invalid_argument, with a text for the user, if the description is no pipeline or has none
     * of the outputs. */
    explicit SourcePipeline(const std::string &launch);
    ~SourcePipeline();
    SourcePipeline(const SourcePipeline &) = delete;
    SourcePipeline &operator=(const SourcePipeline &) = delete;

    const std::set<std::string> &outputs() const { return outputs_; }

    /* From here on, gives out frames, and, once, why there are no more. A source that is not live is slowed
     * down to its frame rate. Call it in the thread that runs `context`, and destroy the pipeline there. */
    void start(GMainContext *context, OnFrame on_frame, OnEnd on_end);

private:
    struct Tap { /* an output, seen by its appsink */
        SourcePipeline *pipeline;
        std::string output;
    };

    void add_output(const std::string &name, GstPad *pad);
    GstFlowReturn take_sample(const std::string &output, GstSample *sample);
    void take_message(GstMessage *message);
    void end(const std::string &reason);

    ObjectPointer<GstPipeline> pipeline_;
    std::map<std::string, ObjectPointer<GstElement>> sinks_;
    std::map<std::string, Tap> taps_;
    std::set<std::string> outputs_;
    std::atomic<GstClockTime> latency_{0};
    GSource *bus_watch_ = nullptr;
    OnFrame on_frame_;
    OnEnd on_end_;
};

} // namespace dff
