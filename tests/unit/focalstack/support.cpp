/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

GstVideoInfo video_info(const char *format, int width, int height)
{
    GstVideoInfo info;
    Owned<GstCaps> caps(gst_caps_from_string(frame_caps(format, width, height).c_str()));
    gst_video_info_from_caps(&info, caps.get());
    return info;
}

std::string frame_caps(const char *format, int width, int height)
{
    return std::string("video/x-raw,format=") + format + ",width=" + std::to_string(width) +
           ",height=" + std::to_string(height) + ",framerate=120/1";
}

uint8_t shade(uint64_t sweep, unsigned plane)
{
    return static_cast<uint8_t>(sweep * 16 + plane + 1);
}

GstBuffer *new_frame(const GstVideoInfo &info, uint64_t sweep, unsigned plane, unsigned planes)
{
    GstBuffer *frame = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
    gst_buffer_memset(frame, 0, shade(sweep, plane), GST_VIDEO_INFO_SIZE(&info));
    const uint64_t number = sweep * planes + plane;
    GST_BUFFER_PTS(frame) = number * frame_duration;
    GST_BUFFER_DURATION(frame) = frame_duration;
    if (planes == 0)
        return frame;

    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = sweep;
    focus.plane = plane;
    focus.planes = planes;
    focus.power = 5.0 - plane;
    focus.frame_id = number;
    gst_buffer_add_focus_meta(frame, &focus);
    return frame;
}

std::vector<uint8_t> shades_of(const GstVideoInfo &info, GstBuffer *stack, unsigned planes)
{
    std::vector<uint8_t> shades;
    for (unsigned z = 0; z < planes; z++) {
        GstVideoFrame frame;
        if (!gst_video_frame_map_id(&frame, &info, stack, static_cast<int>(z), GST_MAP_READ))
            return shades;
        shades.push_back(*static_cast<uint8_t *>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0)));
        gst_video_frame_unmap(&frame);
    }
    return shades;
}

std::vector<uint8_t> shades_of_sweep(uint64_t sweep, unsigned planes)
{
    std::vector<uint8_t> shades;
    for (unsigned z = 0; z < planes; z++)
        shades.push_back(shade(sweep, z));
    return shades;
}

uint64_t count_of(GstElement *mux, const char *name)
{
    GstStructure *stats = nullptr;
    guint64 count = G_MAXUINT64;
    g_object_get(mux, "stats", &stats, nullptr);
    const Owned<GstStructure> owned(stats);
    gst_structure_get_uint64(stats, name, &count);
    return count;
}

unsigned count_messages(GstBus *bus, GstMessageType type)
{
    unsigned count = 0;
    while (GstMessage *message = gst_bus_pop(bus)) {
        count += GST_MESSAGE_TYPE(message) == type;
        gst_message_unref(message);
    }
    return count;
}
