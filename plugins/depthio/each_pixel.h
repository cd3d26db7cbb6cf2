/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/video.h>

namespace dff {

/* Calls work(in, out) with the first bytes of each pixel of two frames of one plane and the same size. */
template <typename Work> void each_pixel(const GstVideoFrame *from, GstVideoFrame *to, Work work)
{
    const int in_step = GST_VIDEO_FRAME_COMP_PSTRIDE(from, 0), out_step = GST_VIDEO_FRAME_COMP_PSTRIDE(to, 0);
    for (int y = 0; y < GST_VIDEO_FRAME_HEIGHT(from); y++) {
        const auto *in = static_cast<const guint8 *>(GST_VIDEO_FRAME_PLANE_DATA(from, 0)) +
                         static_cast<gssize>(y) * GST_VIDEO_FRAME_PLANE_STRIDE(from, 0);
        auto *out = static_cast<guint8 *>(GST_VIDEO_FRAME_PLANE_DATA(to, 0)) +
                    static_cast<gssize>(y) * GST_VIDEO_FRAME_PLANE_STRIDE(to, 0);
        for (int x = 0; x < GST_VIDEO_FRAME_WIDTH(from); x++, in += in_step, out += out_step)
            work(in, out);
    }
}

} // namespace dff
