/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_reader.h"

#include <cmath>
#include <gst/app/gstappsink.h>
#include <gst/dff/dff.h>
#include <gst/video/video.h>
#include <stdexcept>

namespace dff {

namespace {

cv::Mat1b copy_of(GstSample *sample)
{
    GstVideoInfo info;
    GstVideoFrame frame;
    if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
        !gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ))
        throw std::runtime_error("A frame cannot be read.");
    const cv::Mat1b pixels(GST_VIDEO_INFO_HEIGHT(&info), GST_VIDEO_INFO_WIDTH(&info),
                           static_cast<uchar *>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)),
                           static_cast<size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)));
    cv::Mat1b copy = pixels.clone();
    gst_video_frame_unmap(&frame);
    return copy;
}

} // namespace

SweepReader::SweepReader(const std::string &source)
{
    g_autoptr(GError) error = nullptr;
    /* By RGB, since videoconvert copies Y, of 16 to 235, to gray that it says to be of 0 to 255. */
    const std::string description =
        source + " ! videoconvert ! video/x-raw,format=(string){GRAY8,RGB} ! videoconvert ! "
                 "video/x-raw,format=GRAY8 ! appsink name=planes sync=false max-buffers=64";
    GstElement *pipeline = gst_parse_launch(description.c_str(), &error);
    if (pipeline)
        pipeline_.reset(GST_ELEMENT(gst_object_ref_sink(pipeline)));
    if (error)
        throw std::runtime_error("The source \"" + source + "\" cannot be used: " + error->message);
    sink_.reset(gst_bin_get_by_name(GST_BIN(pipeline), "planes"));
    if (gst_element_set_state(pipeline, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
        fail_on_error();
        throw std::runtime_error("The source \"" + source + "\" does not start.");
    }
}

SweepReader::~SweepReader()
{
    if (pipeline_)
        gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
}

void SweepReader::fail_on_error()
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_.get());
    g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    g_autoptr(GError) error = nullptr;
    if (message)
        gst_message_parse_error(message, &error, nullptr);
    if (error) {
        gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
        throw std::runtime_error(error->message);
    }
}

void SweepReader::take(GstSample *sample)
{
    const GstFocusMeta *meta = gst_buffer_get_focus_meta(gst_sample_get_buffer(sample));
    if (!meta)
        throw std::runtime_error(
            "Frames do not say which plane they are: put lenssweeptag planes=N behind the source");
    GstFocusInfo focus;
    gst_focus_meta_get_focus(meta, &focus);
    if (focus.plane >= focus.planes)
        throw std::runtime_error("A frame is said to be a plane that there is not");
    if (focus.sweep != number_ || sweep_.planes.size() != focus.planes) {
        sweep_ = {std::vector<cv::Mat1b>(focus.planes), std::vector<double>(focus.planes, NAN),
                  std::vector<int>(focus.planes, -1)};
        seen_ = 0;
    }
    number_ = focus.sweep;
    seen_ += sweep_.planes[focus.plane].empty() ? 1 : 0;
    sweep_.planes[focus.plane] = copy_of(sample);
    sweep_.powers[focus.plane] = focus.power;
    sweep_.codes[focus.plane] = focus.code;
}

std::optional<Sweep> SweepReader::next()
{
    sweep_ = {};
    while (sweep_.planes.empty() || seen_ < sweep_.planes.size()) {
        g_autoptr(GstSample) sample = gst_app_sink_try_pull_sample(GST_APP_SINK(sink_.get()), GST_SECOND / 4);
        fail_on_error();
        if (sample)
            take(sample);
        else if (gst_app_sink_is_eos(GST_APP_SINK(sink_.get())))
            return std::nullopt;
    }
    return std::move(sweep_);
}

} // namespace dff
