/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

/* What the two files of dffdepth share: the element in dffdepth.cpp, what it does with a stack in
 * dffdepth_chain.cpp. */
#include "dffdepth.h"

#include "depth_statistics.h"
#include "dffdepth_properties.h"
#include "gstcl/compute_latency.h"
#include "gstcl/device_context.h"
#include "output_pads.h"
#include "peak_watch.h"
#include "stack_depth.h"

#include <mutex>
#include <optional>
#include <string>

GST_DEBUG_CATEGORY_EXTERN(dff_depth_debug);
#define GST_CAT_DEFAULT dff_depth_debug

/* What dffdepth knows between two buffers. */
struct GstDffDepthState {
    explicit GstDffDepthState(GstElement *element) : device(element) {}

    /* Guards settings, statistics and latency. Held for copies only: never while the engine works or a pad
     * pushes. */
    std::mutex mutex;
    dff::DepthSettings settings;
    bool settings_changed = true;
    dff::DepthStatistics statistics;
    dff::ComputeLatency latency;

    dff::OutputPads outputs;
    dff::DeviceContext device;

    /* The streaming thread's own. */
    dff::StackDepth depth;
    bool has_caps = false;
    dff::StreamSegment segment{};
    dff::StackClock clock;
    guint64 next_stack = 0;
    std::string last_warning;
    dff::PeakWatch peaks;
    bool told_of_no_peaks = false;
    bool told_of_no_uncertainty = false;
};

struct _GstDffDepth {
    GstElement parent;
    GstPad *sink;
    GstDffDepthState *state;
};

/* The settings, if they have changed since the last call. */
std::optional<dff::DepthSettings> gst_dff_depth_changed_settings(GstDffDepthState &state);

/* The chain function of the pad sink. */
GstFlowReturn gst_dff_depth_chain(GstPad *pad, GstObject *parent, GstBuffer *buffer);
