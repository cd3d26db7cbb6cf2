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

GstCaps *caps_through(GstPad *pad, GstPad *other, GstCaps *(*convert)(const GstCaps *))
{
    g_autoptr(GstCaps) ours = gst_pad_get_pad_template_caps(pad);
    g_autoptr(GstCaps) other_template = gst_pad_get_pad_template_caps(other);
    g_autoptr(GstCaps) allowed = gst_pad_peer_query_caps(other, nullptr);
    g_autoptr(GstCaps) usable = gst_caps_intersect(other_template, allowed);
    g_autoptr(GstCaps) converted = convert(usable);
    return gst_caps_intersect(ours, converted);
}

static GstCaps *of_any_size(const GstCaps *caps)
{
    GstCaps *any = gst_caps_copy(caps);
    for (guint i = 0; i < gst_caps_get_size(any); i++)
        gst_structure_remove_fields(gst_caps_get_structure(any, i), "width", "height", nullptr);
    return any;
}

void answer_caps_query(GstQuery *query, GstPad *pad, GstPad *other, GstCaps *(*convert)(const GstCaps *),
                       Sizes sizes)
{
    GstCaps *filter = nullptr;
    gst_query_parse_caps(query, &filter);
    g_autoptr(GstCaps) result = caps_through(pad, other, convert);
    if (filter) {
        g_autoptr(GstCaps) usable = gst_caps_ref(result);
        gst_caps_take(&result, gst_caps_intersect_full(filter, usable, GST_CAPS_INTERSECT_FIRST));
        if (gst_caps_is_empty(result) && sizes == Sizes::AnyInNeed) {
            g_autoptr(GstCaps) any = of_any_size(usable);
            gst_caps_take(&result, gst_caps_intersect_full(filter, any, GST_CAPS_INTERSECT_FIRST));
        }
    }
    gst_query_set_caps_result(query, result);
}

static int bound_of(const GstStructure *structure, const char *field, bool upper)
{
    int size = 0;
    if (gst_structure_get_int(structure, field, &size))
        return size;
    const GValue *range = gst_structure_get_value(structure, field);
    if (!range || !GST_VALUE_HOLDS_INT_RANGE(range))
        return upper ? G_MAXINT : 1;
    return upper ? gst_value_get_int_range_max(range) : gst_value_get_int_range_min(range);
}

std::string describe_sizes(const GstCaps *caps)
{
    if (gst_caps_is_empty(caps) || gst_caps_is_any(caps))
        return "none";
    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    const auto corner = [structure](bool upper) {
        return std::to_string(bound_of(structure, "width", upper)) + "x" +
               std::to_string(bound_of(structure, "height", upper));
    };
    return corner(false) == corner(true) ? corner(true) : corner(false) + " to " + corner(true);
}

} // namespace dff
