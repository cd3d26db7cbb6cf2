/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/mapped_picture.h"

#include "common/whole_frame.h"

#include <stdexcept>
#include <string>

namespace dff {

MappedPicture::MappedPicture(GstBuffer *buffer, const GstVideoInfo &info)
{
    if (!map_whole(frame_, info, buffer, GST_MAP_READ))
        throw std::runtime_error("A buffer of " + std::to_string(gst_buffer_get_size(buffer)) +
                                 " bytes does not hold the picture its caps describe");
}

PictureView MappedPicture::view() const
{
    return {static_cast<const uint8_t *>(GST_VIDEO_FRAME_PLANE_DATA(&frame_, 0)),
            GST_VIDEO_FRAME_PLANE_STRIDE(&frame_, 0), static_cast<unsigned>(GST_VIDEO_FRAME_WIDTH(&frame_)),
            static_cast<unsigned>(GST_VIDEO_FRAME_HEIGHT(&frame_))};
}

} // namespace dff
