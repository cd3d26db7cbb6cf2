/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "simulated_sweep.h"

#include "picture_converter.h"

SimulatedSweep::SimulatedSweep(dff::SweptCamera camera, const GstVideoInfo &info, const std::stop_token &stop)
    : camera_(std::move(camera))
{
    const PictureConverter converter(info);
    const unsigned planes = camera_.plan().planes();
    const unsigned realisations = camera_.noisy() ? noise_realisations : 1;
    frames_.resize(static_cast<size_t>(planes * realisations));
    for (unsigned plane = 0; plane < planes && !stop.stop_requested(); plane++) {
        const cv::Mat3f exposed = camera_.expose(plane, stop);
        for (unsigned k = 0; k < realisations && !stop.stop_requested(); k++)
            frames_[k * planes + plane].reset(converter.convert(camera_.digitise(exposed, plane, k)));
    }
    GstVideoInfo depth_info;
    gst_video_info_set_format(&depth_info, GST_VIDEO_FORMAT_GRAY16_LE, GST_VIDEO_INFO_WIDTH(&info),
                              GST_VIDEO_INFO_HEIGHT(&info));
    depth_.reset(copy_to_buffer(camera_.depth_map(), depth_info));
}

GstBuffer *SimulatedSweep::frame(guint64 sweep, guint plane) const
{
    return gst_buffer_copy(frames_[(sweep * camera_.plan().planes() + plane) % frames_.size()].get());
}

GstBuffer *SimulatedSweep::depth(guint64) const
{
    return gst_buffer_copy(depth_.get());
}
