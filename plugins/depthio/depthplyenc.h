/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depthfileenc.h"

G_BEGIN_DECLS

#define GST_TYPE_DEPTH_PLY_ENC (gst_depth_ply_enc_get_type())
G_DECLARE_FINAL_TYPE(GstDepthPlyEnc, gst_depth_ply_enc, GST, DEPTH_PLY_ENC, GstDepthFileEnc)

typedef enum {
    GST_DEPTH_PLY_ENC_PROJECTION_PERSPECTIVE,
    GST_DEPTH_PLY_ENC_PROJECTION_ORTHOGRAPHIC
} GstDepthPlyEncProjection;

#define GST_TYPE_DEPTH_PLY_ENC_PROJECTION (gst_depth_ply_enc_projection_get_type())
GType gst_depth_ply_enc_projection_get_type(void);

GST_ELEMENT_REGISTER_DECLARE(depthplyenc)

G_END_DECLS
