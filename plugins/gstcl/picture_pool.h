/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/video.h>

namespace dff {

/* Buffers for pictures of one kind, used again when downstream is done with them. They stay valid when the
 * pool is gone. */
class PicturePool {
public:
    PicturePool() = default;
    ~PicturePool() { stop(); }

    PicturePool(const PicturePool &) = delete;
    PicturePool &operator=(const PicturePool &) = delete;

    /* From here on acquire() gives pictures of this kind. */
    void start(const GstVideoInfo &info);
    void stop();

    /* Returns a picture without timestamps or metas, or nullptr if memory ran out. */
    GstBuffer *acquire();

private:
    GstBufferPool *pool_ = nullptr;
};

} // namespace dff
