/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "common/memory_pool.h"

#include <gst/video/video.h>
#include <optional>

namespace dff {

/* Buffers for pictures of one kind, used again when downstream is done with them. They stay valid when the
 * pool is gone. */
class PicturePool {
public:
    /* From here on acquire() gives pictures of this kind. */
    void start(const GstVideoInfo &info);
    void stop() { pool_.reset(); }

    /* A picture without timestamps or metas. Throws std::runtime_error with a user's text if there is no
     * memory for it, or too little for any such picture. */
    GstBuffer *acquire();

private:
    GstVideoInfo info_{};
    std::optional<MemoryPool> pool_;
};

} // namespace dff
