/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "picture_converter.h"

#include <new>

namespace {

/* The picture's pixels must outlive the buffer. */
GstBuffer *wrap(const cv::Mat3b &picture)
{
    return gst_buffer_new_wrapped_full(GST_MEMORY_FLAG_READONLY, picture.data,
                                       picture.total() * picture.elemSize(), 0,
                                       picture.total() * picture.elemSize(), nullptr, nullptr);
}

GstBuffer *allocate(const GstVideoInfo &info)
{
    GstBuffer *buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
    if (!buffer)
        throw std::bad_alloc();
    return buffer;
}

GstBuffer *seal(GstBuffer *buffer)
{
    GST_MINI_OBJECT_FLAG_SET(gst_buffer_peek_memory(buffer, 0), GST_MEMORY_FLAG_READONLY);
    return buffer;
}

} // namespace

PictureConverter::PictureConverter(const GstVideoInfo &info) : out_info_(info)
{
    gst_video_info_set_format(&in_info_, GST_VIDEO_FORMAT_RGB, GST_VIDEO_INFO_WIDTH(&info),
                              GST_VIDEO_INFO_HEIGHT(&info));
    in_info_.fps_n = info.fps_n;
    in_info_.fps_d = info.fps_d;
    /* OpenCV packs its rows. */
    in_info_.stride[0] = 3 * GST_VIDEO_INFO_WIDTH(&info);
    in_info_.size = static_cast<gsize>(in_info_.stride[0]) * static_cast<gsize>(GST_VIDEO_INFO_HEIGHT(&info));
    converter_.reset(gst_video_converter_new(
        &in_info_, &out_info_,
        gst_structure_new("options", GST_VIDEO_CONVERTER_OPT_THREADS, G_TYPE_UINT, 0U, nullptr)));
}

GstBuffer *PictureConverter::convert(const cv::Mat3b &picture) const
{
    GstBuffer *buffer = allocate(out_info_);
    g_autoptr(GstBuffer) source = wrap(picture);
    GstVideoFrame in;
    GstVideoFrame out;
    gst_video_frame_map(&in, &in_info_, source, GST_MAP_READ);
    gst_video_frame_map(&out, &out_info_, buffer, GST_MAP_WRITE);
    gst_video_converter_frame(converter_.get(), &in, &out);
    gst_video_frame_unmap(&out);
    gst_video_frame_unmap(&in);
    return seal(buffer);
}

GstBuffer *copy_to_buffer(const cv::Mat &picture, const GstVideoInfo &info)
{
    GstBuffer *buffer = allocate(info);
    GstMapInfo map;
    gst_buffer_map(buffer, &map, GST_MAP_WRITE);
    cv::Mat target(picture.size(), picture.type(), map.data,
                   static_cast<size_t>(GST_VIDEO_INFO_PLANE_STRIDE(&info, 0)));
    picture.copyTo(target);
    gst_buffer_unmap(buffer, &map);
    return seal(buffer);
}
