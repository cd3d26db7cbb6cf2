/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_stream.h"

#include "optics/depth_scale.h"

#include <algorithm>
#include <gst/dff/dff.h>

namespace {

constexpr gint default_width = 640;
constexpr gint default_height = 480;

/* The lens settles between two exposures. */
GstClockTime exposure_within(GstClockTime period)
{
    return std::min<GstClockTime>(6 * GST_MSECOND, period / 16 * 15);
}

GstDepthInfo depth_info(const dff::SweepPlan &plan)
{
    const dff::DepthScale scale = dff::DepthEncoder::dioptre(plan).scale();
    GstDepthInfo info;
    gst_depth_info_init(&info);
    info.unit = GST_DEPTH_UNIT_DIOPTRE;
    info.scale = scale.scale;
    info.offset = scale.offset;
    info.near = plan.near();
    info.far = plan.far();
    return info;
}

} // namespace

TestStream::TestStream(const TestSettings &settings) : settings_(settings), plan_(settings.sweep.plan())
{
    settings_.scene.check();
    settings_.scene.natural_size();
    gst_util_double_to_fraction(settings_.rate, &rate_n_, &rate_d_);
    gst_video_info_init(&info_);
}

bool TestStream::finished() const
{
    return settings_.num_buffers >= 0 && frame_ >= static_cast<guint64>(settings_.num_buffers);
}

GstClockTime TestStream::time_of(guint64 frame) const
{
    const guint64 frames_per_n_seconds = static_cast<guint64>(rate_n_) * plan_.planes();
    return first_time_ +
           gst_util_uint64_scale(frame - first_frame_, rate_d_ * GST_SECOND, frames_per_n_seconds);
}

GstClockTime TestStream::frame_duration() const
{
    return time_of(first_frame_ + 1) - first_time_;
}

GstCaps *TestStream::caps(const GstCaps *allowed) const
{
    gint frames_n = 0;
    gint frames_d = 1;
    gst_util_fraction_multiply(rate_n_, rate_d_, static_cast<gint>(plan_.planes()), 1, &frames_n, &frames_d);
    /* One structure a format: an intersection keeps the order of structures. */
    const GstStructure *structure = gst_caps_get_structure(allowed, 0);
    const GValue *formats = gst_structure_get_value(structure, "format");
    GstCaps *caps = gst_caps_new_empty();
    for (guint i = 0; i < gst_value_list_get_size(formats); i++) {
        GstStructure *copy = gst_structure_copy(structure);
        gst_structure_set_value(copy, "format", gst_value_list_get_value(formats, i));
        gst_structure_set(copy, "framerate", GST_TYPE_FRACTION, frames_n, frames_d, "interlace-mode",
                          G_TYPE_STRING, "progressive", nullptr);
        gst_caps_append_structure(caps, copy);
    }
    return caps;
}

GstCaps *TestStream::fixate(GstCaps *caps) const
{
    const cv::Size size = settings_.scene.natural_size().value_or(cv::Size(default_width, default_height));
    caps = gst_caps_make_writable(gst_caps_truncate(caps));
    GstStructure *structure = gst_caps_get_structure(caps, 0);
    gst_structure_fixate_field_nearest_int(structure, "width", size.width);
    gst_structure_fixate_field_nearest_int(structure, "height", size.height);
    if (gst_structure_has_field(structure, "pixel-aspect-ratio"))
        gst_structure_fixate_field_nearest_fraction(structure, "pixel-aspect-ratio", 1, 1);
    return gst_caps_fixate(caps);
}

void TestStream::set_format(const GstVideoInfo &info)
{
    if (gst_video_info_is_equal(&info_, &info))
        return;
    info_ = info;
    pictures_.reset();
    turned_.reset();
}

void TestStream::set_scene(const TestScene &scene)
{
    if (settings_.scene == scene)
        return;
    settings_.scene = scene;
    pictures_.reset();
    turned_.reset();
}

void TestStream::render(const std::stop_token &stop, const SimulatedSweep::Progress &progress)
{
    const cv::Size size(GST_VIDEO_INFO_WIDTH(&info_), GST_VIDEO_INFO_HEIGHT(&info_));
    const auto rendered = [&](bool turned) {
        return std::make_unique<SimulatedSweep>(settings_.scene.camera(plan_, size, stop, turned), info_,
                                                settings_.scene.light().steady(), stop, progress);
    };
    auto pictures = rendered(false);
    if (settings_.scene.cut > 0)
        turned_ = rendered(true);
    if (!stop.stop_requested())
        pictures_ = std::move(pictures);
}

const SimulatedSweep &TestStream::shown(guint64 frame) const
{
    return settings_.scene.is_turned(frame) ? *turned_ : *pictures_;
}

/* What the truth is told of, where a cut falls into the sweep. */
const SimulatedSweep &TestStream::shown_in_middle() const
{
    return shown(frame_ + (plan_.planes() - 1) / 2);
}

void TestStream::postpone(GstClockTime time)
{
    if (time <= time_of(frame_))
        return;
    first_time_ = time;
    first_frame_ = frame_;
}

GstBuffer *TestStream::frame() const
{
    const GstClockTime exposure = exposure_within(frame_duration());
    const double gain =
        settings_.scene.light().gain(frame_, static_cast<double>(time_of(frame_)) / GST_SECOND,
                                     static_cast<double>(exposure) / GST_SECOND);
    GstBuffer *buffer = shown(frame_).frame(sweep(), plane(), gain);
    GST_BUFFER_PTS(buffer) = time_of(frame_);
    GST_BUFFER_DURATION(buffer) = time_of(frame_ + 1) - time_of(frame_);
    GST_BUFFER_OFFSET(buffer) = frame_;
    GST_BUFFER_OFFSET_END(buffer) = frame_ + 1;
    if (frame_ == first_frame_)
        GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);

    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = sweep();
    focus.plane = plane();
    focus.planes = plan_.planes();
    focus.power = plan_.power(plane());
    focus.exposure = exposure;
    focus.frame_id = frame_;
    gst_buffer_add_focus_meta(buffer, &focus);
    return buffer;
}

void TestStream::set_time_of_sweep(GstBuffer *buffer) const
{
    GST_BUFFER_PTS(buffer) = time_of(frame_);
    GST_BUFFER_DURATION(buffer) = time_of(frame_ + plan_.planes()) - time_of(frame_);
    GST_BUFFER_OFFSET(buffer) = sweep();
    GST_BUFFER_OFFSET_END(buffer) = sweep() + 1;
}

GstBuffer *TestStream::motion() const
{
    GstBuffer *buffer = shown_in_middle().motion(sweep());
    set_time_of_sweep(buffer);
    return buffer;
}

GstBuffer *TestStream::depth() const
{
    GstBuffer *buffer = shown_in_middle().depth(sweep());
    set_time_of_sweep(buffer);
    GstDepthInfo info = depth_info(plan_);
    info.sequence = sweep();
    info.sweep = sweep();
    gst_buffer_add_depth_meta(buffer, &info);
    return buffer;
}

GstCaps *TestStream::truth_caps(GstVideoFormat format) const
{
    GstVideoInfo info;
    gst_video_info_set_format(&info, format, GST_VIDEO_INFO_WIDTH(&info_), GST_VIDEO_INFO_HEIGHT(&info_));
    info.fps_n = rate_n_;
    info.fps_d = rate_d_;
    return gst_video_info_to_caps(&info);
}

GstCaps *TestStream::motion_caps() const
{
    return truth_caps(GST_VIDEO_FORMAT_RGBA64_LE);
}

GstCaps *TestStream::depth_caps() const
{
    GstCaps *caps = truth_caps(GST_VIDEO_FORMAT_GRAY16_LE);
    const GstDepthInfo depth = depth_info(plan_);
    gst_depth_info_to_caps(&depth, caps);
    return caps;
}
