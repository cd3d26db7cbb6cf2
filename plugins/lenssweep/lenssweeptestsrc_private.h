/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

/* What the two files of lenssweeptestsrc share: the element in lenssweeptestsrc.cpp, its stream in
 * lenssweeptestsrc_loop.cpp. */
#include "lenssweeptestsrc.h"

#include "live_pacer.h"
#include "test_settings.h"
#include "test_stream.h"

#include <memory>
#include <stop_token>

GST_DEBUG_CATEGORY_EXTERN(gst_lens_sweep_test_src_debug);
#define GST_CAT_DEFAULT gst_lens_sweep_test_src_debug

struct GstLensSweepTestSrcState {
    /* Guarded by the object lock. */
    TestSettings settings;
    bool settings_changed = false;
    bool eos_wanted = false;
    std::stop_source stop; /* of the rendering */
    GstPad *depth_pad = nullptr;
    GstPad *motion_pad = nullptr;

    LivePacer pacer; /* guards itself */

    /* Made in READY to PAUSED, then the streaming thread's alone until PAUSED to READY; the object lock
     * guards the pointer against queries. */
    std::unique_ptr<TestStream> stream;
};

struct _GstLensSweepTestSrc {
    GstElement parent;
    GstPad *src_pad;
    GstLensSweepTestSrcState *state;
};

/* One of the pads of the truth, if there is one; a reference. */
GstPad *gst_lens_sweep_test_src_ref_pad(GstLensSweepTestSrc *self, GstPad *GstLensSweepTestSrcState::*which);

/* GstTaskFunction of the src pad: one frame. */
void gst_lens_sweep_test_src_loop(gpointer self);
