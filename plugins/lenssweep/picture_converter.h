/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/video.h>
#include <memory>
#include <opencv2/core.hpp>

/* Turns R, G, B pictures into buffers of a video format, in its default layout and the colorimetry of `info`.
 */
class PictureConverter {
public:
    PictureConverter(const GstVideoInfo &info);

    /* The buffer has one memory, which is read-only. */
    GstBuffer *convert(const cv::Mat3b &picture) const;

private:
    struct ConverterFree {
        void operator()(GstVideoConverter *converter) const { gst_video_converter_free(converter); }
    };

    GstVideoInfo in_info_;
    GstVideoInfo out_info_;
    std::unique_ptr<GstVideoConverter, ConverterFree> converter_;
};

/* A buffer of the format of `info` around a picture that has its layout but for the stride; memory read-only.
 */
GstBuffer *copy_to_buffer(const cv::Mat &picture, const GstVideoInfo &info);
