/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "depthio/picture_view.h"

#include <gst/video/video.h>

namespace dff {

/* A frame of one component, mapped for reading. Throws std::runtime_error if it cannot be. */
class MappedPicture {
public:
    MappedPicture(GstBuffer *buffer, const GstVideoInfo &info);
    ~MappedPicture() { gst_video_frame_unmap(&frame_); }

    MappedPicture(const MappedPicture &) = delete;
    MappedPicture &operator=(const MappedPicture &) = delete;

    PictureView view() const;

private:
    GstVideoFrame frame_{};
};

} // namespace dff
