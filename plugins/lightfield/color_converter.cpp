/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "color_converter.h"

#include "common/whole_frame.h"

#include <stdexcept>
#include <string>

namespace dff {

namespace {

/* A frame that is mapped as long as this lives. */
class Frame {
public:
    Frame(const GstVideoInfo &info, GstBuffer *buffer, GstMapFlags flags)
    {
        if (!map_whole(frame, info, buffer, flags))
            throw std::runtime_error("A frame's memory does not hold what its caps say");
    }
    ~Frame() { gst_video_frame_unmap(&frame); }

    Frame(const Frame &) = delete;
    Frame &operator=(const Frame &) = delete;

    GstVideoFrame frame;
};

GstVideoInfo in_format(const GstVideoInfo &from, GstVideoFormat format)
{
    GstVideoInfo info;
    gst_video_info_set_format(&info, format, static_cast<guint>(GST_VIDEO_INFO_WIDTH(&from)),
                              static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&from)));
    info.fps_n = from.fps_n;
    info.fps_d = from.fps_d;
    info.interlace_mode = from.interlace_mode;
    return info;
}

} // namespace

void ColorConverter::start(const GstVideoInfo &from, GstVideoFormat format)
{
    stop();
    from_ = to_ = from;
    if (GST_VIDEO_INFO_FORMAT(&from) == format)
        return;
    to_ = in_format(from, format);
    converter_.reset(gst_video_converter_new(
        &from_, &to_,
        gst_structure_new("options", GST_VIDEO_CONVERTER_OPT_DITHER_METHOD, GST_TYPE_VIDEO_DITHER_METHOD,
                          GST_VIDEO_DITHER_NONE, nullptr)));
    if (!converter_)
        throw std::runtime_error(std::string("GStreamer cannot convert ") +
                                 gst_video_format_to_string(GST_VIDEO_INFO_FORMAT(&from)) + " to " +
                                 gst_video_format_to_string(format));
    converted_.reset(gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&to_), nullptr));
    if (!converted_)
        throw std::runtime_error("There is no memory left for a converted picture");
}

void ColorConverter::stop()
{
    converter_.reset();
    converted_.reset();
}

GstBuffer *ColorConverter::convert(GstBuffer *picture)
{
    if (!converter_)
        return picture;
    const Frame source(from_, picture, GST_MAP_READ);
    Frame target(to_, converted_.get(), GST_MAP_WRITE);
    gst_video_converter_frame(converter_.get(), &source.frame, &target.frame);
    return converted_.get();
}

} // namespace dff
