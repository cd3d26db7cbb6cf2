/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_caps.h"

namespace dff {

GstCaps *frame_caps_from_stack_caps(const GstCaps *caps)
{
    GstCaps *frames = gst_caps_copy(caps);
    for (guint i = 0; i < gst_caps_get_size(frames); i++) {
        GstStructure *structure = gst_caps_get_structure(frames, i);
        gst_structure_set_name(structure, "video/x-raw");
        gst_structure_remove_fields(structure, "planes", "framerate", nullptr);
    }
    return frames;
}

GstCaps *stack_caps_from_frame_caps(const GstCaps *caps)
{
    GstCaps *stacks = gst_caps_copy(caps);
    for (guint i = 0; i < gst_caps_get_size(stacks); i++) {
        GstStructure *structure = gst_caps_get_structure(stacks, i);
        gst_structure_set_name(structure, GST_FOCAL_STACK_CAPS_NAME);
        gst_structure_remove_fields(structure, "framerate", "max-framerate", nullptr);
        gst_structure_set(structure, "planes", GST_TYPE_INT_RANGE, 2, GST_FOCAL_STACK_MAX_PLANES, nullptr);
    }
    return stacks;
}

void answer_caps_query(GstQuery *query, GstPad *pad, GstPad *other, GstCaps *(*convert)(const GstCaps *))
{
    GstCaps *filter = nullptr;
    gst_query_parse_caps(query, &filter);

    g_autoptr(GstCaps) ours = gst_pad_get_pad_template_caps(pad);
    g_autoptr(GstCaps) other_template = gst_pad_get_pad_template_caps(other);
    g_autoptr(GstCaps) allowed = gst_pad_peer_query_caps(other, nullptr);
    g_autoptr(GstCaps) usable = gst_caps_intersect(other_template, allowed);
    g_autoptr(GstCaps) converted = convert(usable);
    g_autoptr(GstCaps) result = gst_caps_intersect(ours, converted);
    if (filter)
        gst_caps_take(&result, gst_caps_intersect_full(filter, result, GST_CAPS_INTERSECT_FIRST));
    gst_query_set_caps_result(query, result);
}

} // namespace dff
