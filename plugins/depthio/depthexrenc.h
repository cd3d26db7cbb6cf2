/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depthfileenc.h"

G_BEGIN_DECLS

#define GST_TYPE_DEPTH_EXR_ENC (gst_depth_exr_enc_get_type())
G_DECLARE_FINAL_TYPE(GstDepthExrEnc, gst_depth_exr_enc, GST, DEPTH_EXR_ENC, GstDepthFileEnc)

GST_ELEMENT_REGISTER_DECLARE(depthexrenc)

G_END_DECLS
