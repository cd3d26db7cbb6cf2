/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/meta_events.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace dff {

namespace {

constexpr const char *event_name = "GstDffMeta";
constexpr gsize most_bytes = 16384; /* a stack of 64 planes has a quarter of it */
constexpr size_t most_clocks = 8;
constexpr size_t longest_clock = 1024;

Event event_of(GstStructure *structure)
{
    return Event(gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM, structure));
}

Event event_of_bytes(const char *kind, GBytes *bytes)
{
    g_autoptr(GstBuffer) data = gst_buffer_new_wrapped_bytes(bytes);
    g_bytes_unref(bytes);
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

template <typename Meta> using AddFromBytes = Meta *(*)(GstBuffer *, GBytes *, GError **);

template <typename Meta>
void add(GstBuffer *buffer, const std::vector<guint8> &data, Meta *old, AddFromBytes<Meta> add)
{
    if (data.empty())
        return;
    g_autoptr(GBytes) bytes = g_bytes_new(data.data(), data.size());
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

void PendingMetas::add_bytes(size_t kind, const GstStructure *structure)
{
    g_autoptr(GstBuffer) data = nullptr;
    if (!gst_structure_get(structure, "data", GST_TYPE_BUFFER, &data, nullptr) || !data ||
        gst_buffer_get_size(data) == 0)
        throw std::runtime_error("A recorded meta has no data");
    const gsize size = gst_buffer_get_size(data);
    if (size > most_bytes)
        throw std::runtime_error("A recorded meta is damaged: it has " + std::to_string(size) + " bytes");
    bytes_[kind].resize(size);
    gst_buffer_extract(data, 0, bytes_[kind].data(), size);
}

void PendingMetas::add_time(const GstStructure *structure)
{
    const gchar *clock = gst_structure_get_string(structure, "clock");
    ClockTime time;
    if (!clock || std::string_view(clock).size() > longest_clock ||
        !gst_structure_get_uint64(structure, "timestamp", &time.timestamp) ||
        !gst_structure_get_uint64(structure, "duration", &time.duration))
        throw std::runtime_error("A recorded reference timestamp is damaged");
    time.clock = clock;
    std::erase_if(times_, [&](const ClockTime &old) { return old.clock == time.clock; });
    if (times_.size() == most_clocks)
        throw std::runtime_error("A recorded frame has the times of more than " +
                                 std::to_string(most_clocks) + " clocks");
    times_.push_back(std::move(time));
}

void PendingMetas::add(GstEvent *event)
{
    static constexpr const char *kinds[] = {"focus", "stack", "depth"};
    const GstStructure *structure = gst_event_get_structure(event);
    const gchar *name = gst_structure_get_string(structure, "kind");
    const auto kind =
        static_cast<size_t>(std::find_if(std::begin(kinds), std::end(kinds),
                                         [name](const char *known) { return g_strcmp0(name, known) == 0; }) -
                            std::begin(kinds));
    try {
        if (kind < std::size(kinds))
            add_bytes(kind, structure);
        else if (g_strcmp0(name, "time") == 0)
            add_time(structure);
        else
            throw std::runtime_error("A recorded meta is of a kind that this release does not know");
    } catch (const std::runtime_error &error) {
        if (fault_.empty())
            fault_ = error.what();
    }
}

void PendingMetas::give_to(GstBuffer *buffer)
{
    const PendingMetas metas = std::exchange(*this, {});
    if (!metas.fault_.empty())
        throw std::runtime_error(metas.fault_);
    dff::add(buffer, metas.bytes_[0], gst_buffer_get_focus_meta(buffer),
             gst_buffer_add_focus_meta_from_bytes);
    dff::add(buffer, metas.bytes_[1], gst_buffer_get_focal_stack_meta(buffer),
             gst_buffer_add_focal_stack_meta_from_bytes);
    dff::add(buffer, metas.bytes_[2], gst_buffer_get_depth_meta(buffer),
             gst_buffer_add_depth_meta_from_bytes);
    for (const ClockTime &time : metas.times_) {
        g_autoptr(GstCaps) reference = gst_caps_from_string(time.clock.c_str());
        if (!reference)
            throw std::runtime_error("A recorded reference timestamp is damaged");
        if (GstReferenceTimestampMeta *old = gst_buffer_get_reference_timestamp_meta(buffer, reference))
            gst_buffer_remove_meta(buffer, &old->parent);
        gst_buffer_add_reference_timestamp_meta(buffer, reference, time.timestamp, time.duration);
    }
}

} // namespace dff
