/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "simulated_sweep.h"

#include <algorithm>

SimulatedSweep::SimulatedSweep(dff::SweptCamera camera, const GstVideoInfo &info, const std::stop_token &stop)
    : camera_(std::move(camera)), converter_(info)
{
    gst_video_info_set_format(&depth_info_, GST_VIDEO_FORMAT_GRAY16_LE, GST_VIDEO_INFO_WIDTH(&info),
                              GST_VIDEO_INFO_HEIGHT(&info));
    const unsigned planes = camera_.plan().planes();
    const unsigned realisations = camera_.noisy() ? noise_realisations : 1;
    const size_t count = static_cast<size_t>(planes) * realisations;
    frames_.resize(camera_.has_motion() ? 0 : count);
    backgrounds_.resize(camera_.has_motion() ? count : 0);
    for (unsigned plane = 0; plane < planes && !stop.stop_requested(); plane++) {
        const cv::Mat3f exposed = camera_.expose(plane, stop);
        for (unsigned k = 0; k < realisations && !stop.stop_requested(); k++) {
            const cv::Mat3b picture = camera_.digitise(exposed, plane, k);
            if (camera_.has_motion())
                backgrounds_[k * planes + plane] = picture;
            else
                frames_[k * planes + plane].reset(converter_.convert(picture));
        }
    }
    if (!camera_.has_motion() && !stop.stop_requested())
        depth_.reset(make_depth(0));
}

size_t SimulatedSweep::index(guint64 sweep, guint plane) const
{
    return (sweep * camera_.plan().planes() + plane) % std::max(frames_.size(), backgrounds_.size());
}

GstBuffer *SimulatedSweep::moving_frame(guint64 sweep, guint plane) const
{
    cv::Mat3b picture = backgrounds_[index(sweep, plane)].clone();
    const dff::PicturePatch patch = camera_.expose_motion(sweep, plane);
    /* The background has used the first realisations. */
    camera_.digitise(patch.values, plane, noise_realisations + sweep).copyTo(picture(patch.where));
    return converter_.convert(picture);
}

GstBuffer *SimulatedSweep::make_depth(guint64 sweep) const
{
    return copy_to_buffer(camera_.depth_map(sweep), depth_info_);
}

GstBuffer *SimulatedSweep::frame(guint64 sweep, guint plane) const
{
    return camera_.has_motion() ? moving_frame(sweep, plane)
                                : gst_buffer_copy(frames_[index(sweep, plane)].get());
}

GstBuffer *SimulatedSweep::depth(guint64 sweep) const
{
    return camera_.has_motion() ? make_depth(sweep) : gst_buffer_copy(depth_.get());
}
