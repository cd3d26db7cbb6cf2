/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

G_BEGIN_DECLS

#define GST_TYPE_LENS_SWEEP_TEST_SRC (gst_lens_sweep_test_src_get_type())
G_DECLARE_FINAL_TYPE(GstLensSweepTestSrc, gst_lens_sweep_test_src, GST, LENS_SWEEP_TEST_SRC, GstElement)

GST_ELEMENT_REGISTER_DECLARE(lenssweeptestsrc)

G_END_DECLS
