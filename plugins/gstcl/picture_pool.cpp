/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/picture_pool.h"

#include <stdexcept>

namespace dff {

void PicturePool::start(const GstVideoInfo &info)
{
    info_ = info;
    pool_.emplace(GST_VIDEO_INFO_SIZE(&info));
}

GstBuffer *PicturePool::acquire()
{
    GstMemory *memory = pool_->bytes() <= largest_picture() ? pool_->acquire() : nullptr;
    if (!memory) {
        g_autofree gchar *text =
            g_strdup_printf("There is no memory for a picture of %dx%d %s, which has %" G_GSIZE_FORMAT
                            " bytes: use smaller pictures",
                            GST_VIDEO_INFO_WIDTH(&info_), GST_VIDEO_INFO_HEIGHT(&info_),
                            GST_VIDEO_INFO_NAME(&info_), pool_->bytes());
        throw std::runtime_error(text);
    }
    GstBuffer *buffer = gst_buffer_new();
    gst_buffer_append_memory(buffer, memory);
    return buffer;
}

} // namespace dff
