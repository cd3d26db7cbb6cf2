/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Prints how far away the middle of each depth frame is.
 *
 *     cc read_depth.c -o read_depth $(pkg-config --cflags --libs gstreamer-dff-1.0 gstreamer-app-1.0)
 */
#include <gst/app/gstappsink.h>
#include <gst/dff/dff.h>
#include <gst/gst.h>
#include <gst/video/video.h>

static void print_middle(GstSample *sample)
{
    GstBuffer *buffer = gst_sample_get_buffer(sample);
    GstDepthMeta *depth = gst_buffer_get_depth_meta(buffer);
    GstVideoInfo info;
    GstVideoFrame frame;

    if (!depth || !gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
        !gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ))
        return;
    const guint8 *row = (const guint8 *)GST_VIDEO_FRAME_PLANE_DATA(&frame, 0) +
                        GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0) * (GST_VIDEO_FRAME_HEIGHT(&frame) / 2);
    guint16 pixel = GST_READ_UINT16_LE(row + GST_VIDEO_FRAME_WIDTH(&frame) / 2 * 2);
    if (pixel == 0)
        g_print("sweep %" G_GUINT64_FORMAT ": unknown\n", depth->sweep);
    else /* The unit is dioptres here: see unit= in the pipeline. */
        g_print("sweep %" G_GUINT64_FORMAT ": %.3f dioptres\n", depth->sweep,
                depth->offset + depth->scale * pixel);
    gst_video_frame_unmap(&frame);
}

/* The next sample of a sink; NULL at the end of the stream, and when there is an error, which goes to `failure`. Who waits
 * without looking at the bus waits for ever for a source that cannot start. */
static GstSample *next_sample(GstElement *sink, GstBus *bus, GstMessage **failure)
{
    while (!*failure) {
        GstSample *sample = gst_app_sink_try_pull_sample(GST_APP_SINK(sink), 100 * GST_MSECOND);
        if (sample)
            return sample;
        *failure = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
        if (gst_app_sink_is_eos(GST_APP_SINK(sink)))
            break;
    }
    return NULL;
}

int main(int argc, char **argv)
{
    GError *error = NULL;
    GstMessage *failure = NULL;
    GstSample *sample;

    gst_init(&argc, &argv);
    GstElement *pipeline = gst_parse_launch("lenssweeptestsrc num-buffers=60 near=5 far=0.5 ! focalstackmux ! "
                                            "dffdepth unit=dioptre ! appsink name=depth sync=false",
                                            &error);
    if (error) {
        g_printerr("%s\n", error->message);
        return 1;
    }
    GstElement *sink = gst_bin_get_by_name(GST_BIN(pipeline), "depth");
    GstBus *bus = gst_element_get_bus(pipeline);
    gboolean starts = gst_element_set_state(pipeline, GST_STATE_PLAYING) != GST_STATE_CHANGE_FAILURE;
    while ((sample = next_sample(sink, bus, &failure))) {
        print_middle(sample);
        gst_sample_unref(sample);
    }

    if (!failure)
        failure = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    if (failure) {
        gchar *details = NULL;
        gst_message_parse_error(failure, &error, &details);
        g_printerr("%s (%s)\n", error->message, details);
        g_error_free(error);
        g_free(details);
        gst_message_unref(failure);
    } else if (!starts) {
        g_printerr("The pipeline does not start\n");
    }
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(bus);
    gst_object_unref(sink);
    gst_object_unref(pipeline);
    return !starts || failure != NULL;
}
