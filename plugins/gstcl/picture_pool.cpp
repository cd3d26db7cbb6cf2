/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/picture_pool.h"

namespace dff {

void PicturePool::start(const GstVideoInfo &info)
{
    g_autoptr(GstCaps) caps = gst_video_info_to_caps(&info);

    stop();
    pool_ = gst_video_buffer_pool_new();
    GstStructure *config = gst_buffer_pool_get_config(pool_);
    gst_buffer_pool_config_set_params(config, caps, static_cast<guint>(GST_VIDEO_INFO_SIZE(&info)), 0, 0);
    gst_buffer_pool_set_config(pool_, config);
    gst_buffer_pool_set_active(pool_, TRUE);
}

void PicturePool::stop()
{
    if (pool_)
        gst_buffer_pool_set_active(pool_, FALSE);
    gst_clear_object(&pool_);
}

GstBuffer *PicturePool::acquire()
{
    GstBuffer *buffer = nullptr;
    return gst_buffer_pool_acquire_buffer(pool_, &buffer, nullptr) == GST_FLOW_OK ? buffer : nullptr;
}

} // namespace dff
