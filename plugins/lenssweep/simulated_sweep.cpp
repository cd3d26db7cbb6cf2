/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "simulated_sweep.h"

#include <algorithm>
#include <utility>

namespace {

/* As the KITTI data set has flow, with 16 bits a channel. */
cv::Vec4w motion_pixel(const cv::Vec2f &velocity)
{
    const auto code = [](float pixels) { return cv::saturate_cast<uint16_t>(32768.0F + 64.0F * pixels); };
    return {code(velocity[0]), code(velocity[1]), G_MAXUINT16, G_MAXUINT16};
}

} // namespace

SimulatedSweep::SimulatedSweep(dff::SweptCamera camera, const GstVideoInfo &info, bool steady_light,
                               const std::stop_token &stop, const Progress &progress)
    : camera_(std::move(camera)), converter_(info)
{
    gst_video_info_set_format(&depth_info_, GST_VIDEO_FORMAT_GRAY16_LE, GST_VIDEO_INFO_WIDTH(&info),
                              GST_VIDEO_INFO_HEIGHT(&info));
    gst_video_info_set_format(&motion_info_, GST_VIDEO_FORMAT_RGBA64_LE, GST_VIDEO_INFO_WIDTH(&info),
                              GST_VIDEO_INFO_HEIGHT(&info));
    const unsigned planes = camera_.plan().planes();
    const bool repeats = steady_light && !camera_.has_motion() && !camera_.noisy();
    for (unsigned plane = 0; plane < planes && !stop.stop_requested(); plane++) {
        cv::Mat3f exposed = camera_.expose(plane, stop);
        if (repeats)
            frames_.emplace_back(converter_.convert(camera_.digitise(exposed, plane, 0)));
        else
            exposed_.push_back(std::move(exposed));
        progress(plane, planes);
    }
    if (!camera_.has_motion() && !stop.stop_requested())
        depth_.reset(make_depth(0));
}

GstBuffer *SimulatedSweep::new_frame(guint64 sweep, guint plane, double gain) const
{
    const cv::Mat3f exposed = camera_.seen(exposed_[plane], sweep, plane);
    const cv::Mat3f lit = gain == 1.0 ? exposed : cv::Mat3f(exposed * gain);
    return converter_.convert(camera_.digitise(lit, plane, sweep));
}

GstBuffer *SimulatedSweep::make_depth(guint64 sweep) const
{
    return copy_to_buffer(camera_.depth_map(sweep), depth_info_);
}

GstBuffer *SimulatedSweep::motion(guint64 sweep) const
{
    const cv::Mat2f velocity = camera_.motion_map(sweep);
    cv::Mat_<cv::Vec4w> picture(velocity.size());
    std::transform(velocity.begin(), velocity.end(), picture.begin(), motion_pixel);
    return copy_to_buffer(picture, motion_info_);
}

GstBuffer *SimulatedSweep::frame(guint64 sweep, guint plane, double gain) const
{
    return frames_.empty() ? new_frame(sweep, plane, gain) : gst_buffer_copy(frames_[plane].get());
}

GstBuffer *SimulatedSweep::depth(guint64 sweep) const
{
    return camera_.has_motion() ? make_depth(sweep) : gst_buffer_copy(depth_.get());
}
