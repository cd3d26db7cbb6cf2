/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstpushsrc.h>

G_BEGIN_DECLS

#define GST_TYPE_LENS_SWEEP_SRC (gst_lens_sweep_src_get_type())
G_DECLARE_FINAL_TYPE(GstLensSweepSrc, gst_lens_sweep_src, GST, LENS_SWEEP_SRC, GstPushSrc)

GST_ELEMENT_REGISTER_DECLARE(lenssweepsrc)

G_END_DECLS
