/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstaggregator.h>
#include <gst/dff/dff.h>
#include <vector>

namespace dff {

/* A picture, its depth and, if they came, the stack it was computed from and how uncertain the depth is. */
struct FrameSet {
    GstBuffer *colour;
    const GstVideoInfo *colour_info;
    GstBuffer *depth;
    const GstVideoInfo *depth_info;
    const GstCaps *depth_caps;
    GstBuffer *stack; /* or nullptr */
    const GstFocalStackInfo *stack_info;
    GstBuffer *uncertainty; /* or nullptr; one standard deviation in the pixels of the depth */
    const GstVideoInfo *uncertainty_info;
};

} // namespace dff

#define GST_TYPE_DEPTH_FILE_ENC (gst_depth_file_enc_get_type())
G_DECLARE_DERIVABLE_TYPE(GstDepthFileEnc, gst_depth_file_enc, GST, DEPTH_FILE_ENC, GstAggregator)

/* What encoders of colour and depth share: the pads `color` and `depth`, the request pad `uncertainty`, and
 * `stack` where the derived class has a template for it. What is requested may come and go while the others
 * stream. Frames of equal running time belong together. */
struct _GstDepthFileEncClass {
    GstAggregatorClass parent_class;

    /* The file of one set of frames of one size; throws std::exception with a user's text. */
    std::vector<guint8> (*encode)(GstDepthFileEnc *self, const dff::FrameSet &frames);
};
