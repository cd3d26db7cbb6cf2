/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/meta_events.h"

#include <stdexcept>

namespace dff {

namespace {

constexpr const char *event_name = "GstDffMeta";

Event event_of(GstStructure *structure)
{
    return Event(gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM, structure));
}

Event event_of_bytes(const char *kind, GBytes *bytes)
{
    g_autoptr(GBytes) owned = bytes;
    g_autoptr(GstBuffer) data = gst_buffer_new_wrapped_bytes(bytes);
    return event_of(
        gst_structure_new(event_name, "kind", G_TYPE_STRING, kind, "data", GST_TYPE_BUFFER, data, nullptr));
}

Event event_of_time(const GstReferenceTimestampMeta *meta)
{
    g_autofree gchar *clock = gst_caps_to_string(meta->reference);
    return event_of(gst_structure_new(event_name, "kind", G_TYPE_STRING, "time", "clock", G_TYPE_STRING,
                                      clock, "timestamp", G_TYPE_UINT64, meta->timestamp, "duration",
                                      G_TYPE_UINT64, meta->duration, nullptr));
}

void add_time(GstBuffer *buffer, const GstStructure *structure)
{
    const gchar *clock = gst_structure_get_string(structure, "clock");
    g_autoptr(GstCaps) reference = clock ? gst_caps_from_string(clock) : nullptr;
    GstClockTime timestamp = 0, duration = 0;
    if (!reference || !gst_structure_get_uint64(structure, "timestamp", &timestamp) ||
        !gst_structure_get_uint64(structure, "duration", &duration))
        throw std::runtime_error("A recorded reference timestamp is damaged");
    if (GstReferenceTimestampMeta *old = gst_buffer_get_reference_timestamp_meta(buffer, reference))
        gst_buffer_remove_meta(buffer, &old->parent);
    gst_buffer_add_reference_timestamp_meta(buffer, reference, timestamp, duration);
}

GBytes *bytes_of(const GstStructure *structure)
{
    g_autoptr(GstBuffer) data = nullptr;
    if (!gst_structure_get(structure, "data", GST_TYPE_BUFFER, &data, nullptr) || !data)
        throw std::runtime_error("A recorded meta has no data");
    gpointer copy = nullptr;
    gsize size = 0;
    gst_buffer_extract_dup(data, 0, gst_buffer_get_size(data), &copy, &size);
    return g_bytes_new_take(copy, size);
}

template <typename Meta> using AddFromBytes = Meta *(*)(GstBuffer *, GBytes *, GError **);

template <typename Meta>
void add(GstBuffer *buffer, const GstStructure *structure, Meta *old, AddFromBytes<Meta> add)
{
    g_autoptr(GBytes) bytes = bytes_of(structure);
    g_autoptr(GError) error = nullptr;
    if (old)
        gst_buffer_remove_meta(buffer, &old->meta);
    if (!add(buffer, bytes, &error))
        throw std::runtime_error(error->message);
}

} // namespace

std::vector<Event> events_of_metas(GstBuffer *buffer)
{
    std::vector<Event> events;
    gpointer state = nullptr;
    while (GstMeta *meta = gst_buffer_iterate_meta(buffer, &state)) {
        if (meta->info->api == GST_FOCUS_META_API_TYPE)
            events.push_back(
                event_of_bytes("focus", gst_focus_meta_to_bytes(reinterpret_cast<GstFocusMeta *>(meta))));
        else if (meta->info->api == GST_FOCAL_STACK_META_API_TYPE)
            events.push_back(event_of_bytes(
                "stack", gst_focal_stack_meta_to_bytes(reinterpret_cast<GstFocalStackMeta *>(meta))));
        else if (meta->info->api == GST_DEPTH_META_API_TYPE)
            events.push_back(
                event_of_bytes("depth", gst_depth_meta_to_bytes(reinterpret_cast<GstDepthMeta *>(meta))));
        else if (meta->info->api == GST_REFERENCE_TIMESTAMP_META_API_TYPE)
            events.push_back(event_of_time(reinterpret_cast<GstReferenceTimestampMeta *>(meta)));
    }
    return events;
}

bool is_meta_event(GstEvent *event)
{
    return gst_event_has_name(event, event_name);
}

void add_meta_of_event(GstBuffer *buffer, GstEvent *event)
{
    const GstStructure *structure = gst_event_get_structure(event);
    const gchar *kind = gst_structure_get_string(structure, "kind");
    if (g_strcmp0(kind, "focus") == 0)
        add(buffer, structure, gst_buffer_get_focus_meta(buffer), gst_buffer_add_focus_meta_from_bytes);
    else if (g_strcmp0(kind, "stack") == 0)
        add(buffer, structure, gst_buffer_get_focal_stack_meta(buffer),
            gst_buffer_add_focal_stack_meta_from_bytes);
    else if (g_strcmp0(kind, "depth") == 0)
        add(buffer, structure, gst_buffer_get_depth_meta(buffer), gst_buffer_add_depth_meta_from_bytes);
    else if (g_strcmp0(kind, "time") == 0)
        add_time(buffer, structure);
    else
        throw std::runtime_error("A recorded meta is of a kind that this release does not know");
}

} // namespace dff
