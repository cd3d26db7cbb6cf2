/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depth_maps.h"

#include <gst/base/gstflowcombiner.h>
#include <mutex>

namespace dff {

/* The source pads of dffdepth, the depth first. Pads may come and go while the stream runs. */
class OutputPads {
public:
    OutputPads() : flows_(gst_flow_combiner_new()) {}
    ~OutputPads() { gst_flow_combiner_free(flows_); }

    OutputPads(const OutputPads &) = delete;
    OutputPads &operator=(const OutputPads &) = delete;

    /* Any thread. */
    void add(GstElement *element, GstPad *pad, GstVideoFormat format);
    void remove(GstPad *pad);

    /* The streaming thread, or while there is none. */
    std::vector<std::shared_ptr<DepthOutput>> outputs() const;

    /* DepthOutput::open() and restart() of each; after a restart no flow is remembered. */
    void open();
    void restart();

    /* DepthOutput::end() and pass_gap() of each. */
    void end(const StreamSegment &segment);
    void pass_gap(GstEvent *gap, const StreamSegment &segment);

    /* Pushes the maps and returns what upstream is to know of it. */
    GstFlowReturn push(DepthMaps &maps);

private:
    /* A leaf: held for a few lines, never while a pad pushes. */
    mutable std::mutex mutex_;
    std::vector<std::shared_ptr<DepthOutput>> outputs_;
    GstFlowCombiner *flows_;
};

} // namespace dff
