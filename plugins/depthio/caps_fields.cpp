/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/caps_fields.h"

namespace dff {

GstCaps *caps_in_format(const GstCaps *caps, const char *format, GstCaps *filter)
{
    GstCaps *other = gst_caps_copy(caps);
    for (guint i = 0; i < gst_caps_get_size(other); i++) {
        GstStructure *structure = gst_caps_get_structure(other, i);
        gst_structure_remove_fields(structure, "colorimetry", "chroma-site", "depth-unit", "depth-near",
                                    "depth-far", nullptr);
        gst_structure_set(structure, "format", G_TYPE_STRING, format, nullptr);
    }
    if (!filter)
        return other;
    GstCaps *common = gst_caps_intersect_full(filter, other, GST_CAPS_INTERSECT_FIRST);
    gst_caps_unref(other);
    return common;
}

} // namespace dff
