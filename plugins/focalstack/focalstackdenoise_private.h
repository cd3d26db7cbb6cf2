/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

/* What the two files of focalstackdenoise share: the element in focalstackdenoise.cpp, what it does with a
 * stack in focalstackdenoise_transform.cpp. */
#include "focalstack/focalstackdenoise.h"

#include "common/stack_place.h"
#include "focalstack/bad_pixels.h"
#include "focalstack/focalstackdenoise_properties.h"
#include "focalstack/sweep_follower.h"
#include "gstcl/compute_latency.h"
#include "gstcl/device_context.h"

#include <gst/dff/dff.h>
#include <mutex>
#include <optional>

GST_DEBUG_CATEGORY_EXTERN(focalstackdenoise_debug);
#define GST_CAT_DEFAULT focalstackdenoise_debug

/* What focalstackdenoise knows between two buffers. */
struct GstFocalStackDenoiseState {
    explicit GstFocalStackDenoiseState(GstElement *element) : context(element) {}

    dff::DeviceContext context;

    /* The streaming thread's own. */
    std::shared_ptr<dff::Device> device;
    std::optional<GstFocalStackInfo> info;
    std::unique_ptr<dff::StackDenoiser> denoiser; /* for info; empty until the first stack of these caps */
    std::unique_ptr<dff::SweepFollower> follower; /* for info, while local-motion is wanted */
    dff::BadPixels bad_pixels;
    std::optional<dff::StackPlace> place; /* of the last stack, if focalstackalign told it */

    std::mutex mutex; /* guards what follows; nothing is locked under it */
    dff::DenoiseSettings settings;
    double moved = 0.0; /* part of the last stack */
    guint64 bad_pixel_count = 0;
    dff::DenoiseReport report;
    guint64 stacks = 0;
    dff::ComputeLatency latency;
};

struct _GstFocalStackDenoise {
    GstBaseTransform parent;
    GstFocalStackDenoiseState *state;
};

/* The transform_ip function of GstBaseTransform. */
GstFlowReturn gst_focal_stack_denoise_transform_ip(GstBaseTransform *base, GstBuffer *buffer);
