/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

/* What the two files of lenssweepsrc share: the element in lenssweepsrc.cpp, its stream in
 * lenssweepsrc_create.cpp. */
#include "lenssweepsrc.h"

#include "camera_properties.h"
#include "plane_buffer.h"

#include <atomic>
#include <exception>
#include <memory>

GST_DEBUG_CATEGORY_EXTERN(gst_lens_sweep_src_debug);
#define GST_CAT_DEFAULT gst_lens_sweep_src_debug

struct GstLensSweepSrcState {
    /* Guarded by the object lock, within which nothing is locked but the capture's own mutexes. */
    CameraProperties properties;
    bool changed = false;      /* rate, exposure or gain, while running */
    dff::CaptureCounts counts; /* as of the last frame */
    guint64 delivered = 0;
    GstClockTime latency = GST_CLOCK_TIME_NONE;
    GstClockTime max_latency = GST_CLOCK_TIME_NONE;
    std::shared_ptr<dff::SweepCapture> capture; /* the pointer; set by start() and stop() */
    dff::CaptureSettings settings;              /* written by start() and the streaming thread, which alone
                                                   read it without the lock */

    std::atomic<bool> flushing = false;
    std::atomic<bool> failed = false;         /* an error was posted since the start */
    std::atomic<gint64> playing_since_ns = 0; /* frames that arrived before are stale */

    /* The streaming thread's alone, between start() and stop(). */
    CameraFormat format;
    bool running = false;
    guint64 missing = 0; /* planes that were reported */
    GstCaps *clock_caps = nullptr;
    std::vector<double> calibrated_powers; /* dioptres, a plane each; empty without a calibration */
};

struct _GstLensSweepSrc {
    GstPushSrc parent;
    GstLensSweepSrcState *state;
};

/* Says what is wrong as an element error. */
void gst_lens_sweep_src_post_error(GstLensSweepSrc *self, const std::exception &error);

/* GstPushSrcClass.create */
GstFlowReturn gst_lens_sweep_src_create(GstPushSrc *source, GstBuffer **buffer);
