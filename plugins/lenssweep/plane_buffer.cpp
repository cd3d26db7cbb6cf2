/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "plane_buffer.h"

#include <gst/dff/dff.h>

namespace {

/* The camera's memory itself; it goes back when the last reader lets go of it. */
GstBuffer *wrapped(dff::CapturedPlane &plane, gsize size)
{
    const auto pixels = plane.buffer.pixels();
    auto *owner = new dff::CameraBuffer(std::move(plane.buffer));
    const auto release = +[](gpointer buffer) { delete static_cast<dff::CameraBuffer *>(buffer); };
    return gst_buffer_new_wrapped_full(static_cast<GstMemoryFlags>(0), pixels.data(), pixels.size(), 0, size,
                                       owner, release);
}

GstBuffer *copied(const dff::CapturedPlane &plane, const CameraFormat &format, gsize size)
{
    GstBuffer *buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
    GstMapInfo map;
    if (gst_buffer_map(buffer, &map, GST_MAP_WRITE)) {
        dff::copy_picture(*format.layout, static_cast<unsigned>(format.width),
                          static_cast<unsigned>(format.height), plane.buffer.pixels(), {map.data, map.size});
        gst_buffer_unmap(buffer, &map);
    }
    return buffer;
}

} // namespace

GstBuffer *plane_buffer(dff::CapturedPlane plane, const PlaneOutput &output)
{
    const CameraFormat &format = output.format;
    const auto width = static_cast<unsigned>(format.width);
    const auto height = static_cast<gsize>(format.height);
    if (plane.buffer.pixels().size() < gsize{width} * format.layout->bytes * height)
        return nullptr;
    const gsize size = format.layout->stride(width) * height;
    const bool in_place = format.layout->usable_in_place(width);
    GstBuffer *buffer = in_place ? wrapped(plane, size) : copied(plane, format, size);

    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.sweep = plane.sweep;
    focus.plane = plane.plane;
    focus.planes = output.planes;
    focus.power = output.power;
    focus.code = output.code;
    focus.exposure = output.exposure;
    focus.frame_id = plane.frame.id;
    gst_buffer_add_focus_meta(buffer, &focus);
    if (plane.frame.camera_ns != 0)
        gst_buffer_add_reference_timestamp_meta(
            buffer, output.clock_caps, static_cast<GstClockTime>(plane.frame.camera_ns), output.exposure);
    GST_BUFFER_DURATION(buffer) = output.duration;
    return buffer;
}

GstStructure *capture_stats(const dff::CaptureCounts &counts, guint64 delivered)
{
    return gst_structure_new(
        "application/x-lenssweepsrc-stats", "delivered", G_TYPE_UINT64, delivered, "lost", G_TYPE_UINT64,
        counts.labels.lost, "incomplete", G_TYPE_UINT64, counts.incomplete, "underruns", G_TYPE_UINT64,
        counts.underruns, "doubled", G_TYPE_UINT64, counts.labels.doubled, "unlabelled", G_TYPE_UINT64,
        counts.labels.unlabelled, "disagreements", G_TYPE_UINT64, counts.labels.disagreements,
        "dropped-sweeps", G_TYPE_UINT64, counts.labels.dropped_sweeps, "wrong-edges", G_TYPE_UINT64,
        counts.wrong_edges, "wrong-counts", G_TYPE_UINT64, counts.wrong_counts, "triggers", G_TYPE_UINT64,
        counts.triggers, "restarts", G_TYPE_UINT64, counts.restarts, nullptr);
}

guint64 missing_planes(const dff::CaptureCounts &counts)
{
    return counts.labels.lost + counts.labels.unlabelled - counts.labels.doubled;
}
