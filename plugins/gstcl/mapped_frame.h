/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <gst/video/video.h>
#include <span>

namespace dff {

/* A frame of one plane, such as a depth map or an RGB picture, mapped as long as this lives. */
class MappedFrame {
public:
    /* Throws std::runtime_error with a user's text if the buffer does not hold what the caps say. */
    MappedFrame(const GstVideoInfo &info, GstBuffer *buffer, GstMapFlags flags);
    ~MappedFrame() { gst_video_frame_unmap(&frame_); }

    MappedFrame(const MappedFrame &) = delete;
    MappedFrame &operator=(const MappedFrame &) = delete;

    /* From the first row's first byte to the last row's last one. */
    std::span<std::byte> memory() const;
    size_t stride() const { return static_cast<size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame_, 0)); }

private:
    GstVideoFrame frame_;
};

/* Throws std::runtime_error with a user's text unless the depth map has the size of `main`, which `name`
 * calls by its name. */
void require_size(const GstVideoInfo &depth, const GstVideoInfo &main, const char *name);

/* Gives a picture the time of `timed`, the camera clock of `main` and its number. */
void stamp_picture(GstBuffer *picture, GstBuffer *timed, GstBuffer *main, guint64 number);

} // namespace dff
