/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_frame.h"

namespace dff {

Harness depth_harness(const std::string &pipeline, unsigned width, unsigned height)
{
    Harness harness(gst_harness_new_parse(pipeline.c_str()));
    g_autofree gchar *caps =
        g_strdup_printf("video/x-raw,format=GRAY16_LE,width=%u,height=%u,framerate=26/1,depth-unit=dioptre,"
                        "depth-near=5.0,depth-far=1.0",
                        width, height);
    gst_harness_set_src_caps_str(harness.get(), caps);
    return harness;
}

GstDepthInfo dioptres_from_5_to_1()
{
    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    depth.unit = GST_DEPTH_UNIT_DIOPTRE;
    depth.near = 5.0;
    depth.far = 1.0;
    depth.scale = (depth.far - depth.near) / 65534;
    depth.offset = depth.near - depth.scale;
    return depth;
}

Buffer depth_frame(unsigned width, unsigned height, const PixelAt &pixel_at)
{
    GstBuffer *frame = gst_buffer_new_allocate(nullptr, gsize{2} * width * height, nullptr);
    GstMapInfo map;
    gst_buffer_map(frame, &map, GST_MAP_WRITE);
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++)
            GST_WRITE_UINT16_LE(map.data + 2 * (gsize{y} * width + x), pixel_at(x, y));
    gst_buffer_unmap(frame, &map);
    GST_BUFFER_PTS(frame) = 0;
    return Buffer(frame);
}

std::vector<guint16> pixels_of(GstBuffer *frame)
{
    GstMapInfo map;
    gst_buffer_map(frame, &map, GST_MAP_READ);
    std::vector<guint16> pixels(map.size / 2);
    for (size_t k = 0; k < pixels.size(); k++)
        pixels[k] = GST_READ_UINT16_LE(map.data + 2 * k);
    gst_buffer_unmap(frame, &map);
    return pixels;
}

std::string caps_string(GstHarness *harness)
{
    g_autoptr(GstCaps) caps = gst_pad_get_current_caps(harness->sinkpad);
    g_autofree gchar *text = caps ? gst_caps_to_string(caps) : g_strdup("");
    return text;
}

} // namespace dff
