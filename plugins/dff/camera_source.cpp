/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_source.h"

#include <gst/dff/dff.h>
#include <utility>

GST_DEBUG_CATEGORY_EXTERN(dff_camera_bin_debug);
#define GST_CAT_DEFAULT dff_camera_bin_debug

namespace dff {

GstElement *make_camera_source(const std::string &description, std::string &error)
{
    /* The element at the end lets a description end in caps, and holds the link of a pad that is still to
     * come. */
    const std::string text = description + " ! identity name=" + source_end;
    g_autoptr(GError) parse_error = nullptr;
    GstElement *bin = gst_parse_bin_from_description_full(text.c_str(), FALSE, nullptr,
                                                          GST_PARSE_FLAG_FATAL_ERRORS, &parse_error);
    if (!bin) {
        error = parse_error ? parse_error->message : "it cannot be parsed";
        return nullptr;
    }
    g_autoptr(GstElement) end = gst_bin_get_by_name(GST_BIN(bin), source_end);
    g_autoptr(GstPad) pad = gst_element_get_static_pad(end, "src");
    gst_element_add_pad(bin, gst_ghost_pad_new("src", pad));
    return bin;
}

SourceRoute::SourceRoute(GstElement *planes, GstElement *mux, GstElement *stacks,
                         std::function<void(const std::string &reason)> on_fault)
    : planes_(planes), mux_(mux), stacks_(stacks), on_fault_(std::move(on_fault))
{
}

std::string SourceRoute::connect(GstPad *source)
{
    constexpr auto types = static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM |
                                                        GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM);
    gst_pad_add_probe(source, types, probe, this, nullptr);
    lead(source, false);
    g_autoptr(GstCaps) caps = gst_pad_query_caps(source, nullptr);
    return fault_of(caps);
}

GstPadProbeReturn SourceRoute::probe(GstPad *source, GstPadProbeInfo *info, gpointer self)
{
    auto *route = static_cast<SourceRoute *>(self);
    if (info->type & GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM)
        return route->answer(GST_PAD_PROBE_INFO_QUERY(info));
    GstEvent *event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) != GST_EVENT_CAPS)
        return GST_PAD_PROBE_OK;
    GstCaps *caps = nullptr;
    gst_event_parse_caps(event, &caps);
    return route->take_caps(source, caps);
}

GstPadProbeReturn SourceRoute::take_caps(GstPad *source, GstCaps *caps)
{
    const std::string fault = fault_of(caps);
    if (!fault.empty()) {
        on_fault_(fault);
        return GST_PAD_PROBE_DROP;
    }
    const bool stacks =
        gst_structure_has_name(gst_caps_get_structure(caps, 0), GST_FOCAL_STACK_CAPS_NAME) != FALSE;
    GST_INFO_OBJECT(source, "The source gives %s: %" GST_PTR_FORMAT, stacks ? "stacks" : "frames", caps);
    lead(source, stacks);
    GST_OBJECT_LOCK(planes_);
    const bool planes_wanted = planes_->numsrcpads > 1; /* by others than the mux */
    GST_OBJECT_UNLOCK(planes_);
    if (stacks && planes_wanted)
        on_fault_("it gives focal stacks, so that nothing comes out of the pad planes");
    return GST_PAD_PROBE_OK;
}

GstPadProbeReturn SourceRoute::answer(GstQuery *query) const
{
    GstCaps *caps = nullptr;
    if (GST_QUERY_TYPE(query) == GST_QUERY_CAPS) {
        gst_query_parse_caps(query, &caps);
        g_autoptr(GstCaps) possible = possible_caps(caps);
        gst_query_set_caps_result(query, possible);
        return GST_PAD_PROBE_HANDLED;
    }
    if (GST_QUERY_TYPE(query) == GST_QUERY_ACCEPT_CAPS) {
        gst_query_parse_accept_caps(query, &caps);
        gst_query_set_accept_caps_result(query, fault_of(caps).empty());
        return GST_PAD_PROBE_HANDLED;
    }
    return GST_PAD_PROBE_OK;
}

GstCaps *SourceRoute::possible_caps(GstCaps *filter) const
{
    g_autoptr(GstPad) frames = gst_element_get_static_pad(planes_, "sink");
    g_autoptr(GstPad) stacks = gst_element_get_static_pad(stacks_, "sink");
    return gst_caps_merge(gst_pad_query_caps(frames, filter), gst_pad_query_caps(stacks, filter));
}

std::string SourceRoute::fault_of(GstCaps *caps) const
{
    g_autoptr(GstCaps) possible = possible_caps(nullptr);
    if (gst_caps_can_intersect(caps, possible))
        return "";
    g_autofree gchar *text = gst_caps_to_string(caps);
    return "its caps \"" + std::string(text) +
           "\" are no frames or focal stacks of a format and size (64x64 to 16384x16384) that dffdepth takes";
}

void SourceRoute::lead(GstPad *source, bool stacks)
{
    g_autoptr(GstPad) before = gst_pad_get_peer(source);
    g_autoptr(GstPad) target = gst_element_get_static_pad(stacks ? stacks_ : planes_, "sink");
    if (before == target)
        return;
    if (before)
        gst_pad_unlink(source, before);
    if (stacks)
        gst_element_unlink(mux_, stacks_);
    gst_pad_link_full(source, target, GST_PAD_LINK_CHECK_NOTHING);
    if (!stacks)
        gst_element_link_pads(mux_, "src", stacks_, "sink");
}

} // namespace dff
