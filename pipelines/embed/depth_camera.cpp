/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * All-in-focus pictures, depth in millimetres and what is known of both, as arrays, from sources in turn:
 *
 *     depth_camera                                   a simulated camera
 *     depth_camera "lenssweepsrc lens=... planes=6"  a real one
 *     depth_camera "lenssweeptestsrc num-buffers=60" "lenssweepsrc num-buffers=600"
 *
 *     c++ -std=c++20 -o depth_camera depth_camera.cpp \
 *         $(pkg-config --cflags --libs gstreamer-dff-1.0 gstreamer-app-1.0)
 */
#include <gst/app/gstappsink.h>
#include <gst/dff/dff.h>
#include <gst/gst.h>
#include <gst/video/video.h>
#include <string>
#include <vector>

/* The next sample of a sink; nullptr at the end of the stream, and when there is an error, which goes to
 * `failure`. Who waits without looking at the bus waits for ever for a source that cannot start. */
static GstSample *next_sample(GstElement *sink, GstBus *bus, GstMessage **failure)
{
    while (!*failure) {
        if (GstSample *sample = gst_app_sink_try_pull_sample(GST_APP_SINK(sink), 100 * GST_MSECOND))
            return sample;
        *failure = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
        if (gst_app_sink_is_eos(GST_APP_SINK(sink)))
            break;
    }
    return nullptr;
}

/* A sample's frame, its rows packed; empty without a sample. */
struct Frame {
    int width = 0, height = 0;
    std::vector<guint8> bytes;
    GstDepthInfo depth{}; /* of depth frames */

    /* Takes the sample. */
    explicit Frame(GstSample *taken)
    {
        g_autoptr(GstSample) sample = taken;
        GstVideoInfo info;
        GstVideoFrame frame;
        if (!sample || !gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
            !gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ))
            return;
        width = GST_VIDEO_FRAME_WIDTH(&frame);
        height = GST_VIDEO_FRAME_HEIGHT(&frame);
        const int row_bytes = width * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, 0);
        for (int y = 0; y < height; y++) {
            const auto *row = static_cast<const guint8 *>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)) +
                              static_cast<gssize>(y) * GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0);
            bytes.insert(bytes.end(), row, row + row_bytes);
        }
        if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(frame.buffer))
            gst_depth_meta_get_depth(meta, &depth);
        gst_video_frame_unmap(&frame);
    }
};

int main(int argc, char **argv)
{
    gst_init(&argc, &argv);
    std::vector<std::string> sources(argv + 1, argv + argc);
    if (sources.empty())
        sources = {"lenssweeptestsrc num-buffers=60 near=5 far=0.5"};

    g_autoptr(GError) error = nullptr;
    g_autoptr(GstElement) pipeline = gst_parse_launch(
        "dffcamerabin name=camera unit=millimetre  camera.depth ! appsink name=depth sync=false "
        "max-buffers=2 "
        "camera.aif ! videoconvert ! video/x-raw,format=RGB ! appsink name=aif sync=false max-buffers=2",
        &error);
    if (error) {
        g_printerr("%s\n", error->message);
        return 1;
    }
    g_autoptr(GstElement) camera = gst_bin_get_by_name(GST_BIN(pipeline), "camera");
    g_autoptr(GstElement) depth_sink = gst_bin_get_by_name(GST_BIN(pipeline), "depth");
    g_autoptr(GstElement) aif_sink = gst_bin_get_by_name(GST_BIN(pipeline), "aif");
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);

    for (const std::string &source : sources) {
        g_object_set(camera, "source", source.c_str(), nullptr);
        const bool starts = gst_element_set_state(pipeline, GST_STATE_PLAYING) != GST_STATE_CHANGE_FAILURE;
        g_autoptr(GstMessage) failure = nullptr;
        for (int count = 0; starts; count++) {
            const Frame depth(next_sample(depth_sink, bus, &failure)),
                aif(next_sample(aif_sink, bus, &failure));
            if (depth.bytes.empty() || aif.bytes.empty())
                break;
            const size_t middle = static_cast<size_t>(depth.height / 2 * depth.width + depth.width / 2);
            const auto *millimetres =
                reinterpret_cast<const guint16 *>(depth.bytes.data()); /* 0 is unknown */
            const guint8 *rgb = &aif.bytes[3 * middle];
            g_print("sweep %" G_GUINT64_FORMAT " of %g to %g dioptres: %d mm, colour %d %d %d\n",
                    depth.depth.sweep, depth.depth.near, depth.depth.far, millimetres[middle], rgb[0], rgb[1],
                    rgb[2]);
            if (count == 2) /* any property of dffdepth and aifcompose can change while it runs */
                gst_util_set_object_arg(G_OBJECT(camera), "blend", "sharp");
        }
        if (!failure)
            failure = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
        gst_element_set_state(pipeline, GST_STATE_NULL);
        if (failure) {
            g_autofree gchar *details = nullptr;
            gst_message_parse_error(failure, &error, &details);
            g_printerr("%s (%s)\n", error->message, details);
            return 1;
        }
        if (!starts) {
            g_printerr("The source does not start: %s\n", source.c_str());
            return 1;
        }
    }
    return 0;
}
