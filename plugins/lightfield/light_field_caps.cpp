/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "light_field_caps.h"

#include <cmath>

namespace dff {

namespace {

/* How two views are packed, in GStreamer's words; nullptr for anything else. */
const char *stereo_mode(const LightFieldParameters &parameters)
{
    if (parameters.layout != LightFieldLayout::Views || parameters.columns * parameters.rows != 2)
        return nullptr;
    return gst_video_multiview_mode_to_caps_string(parameters.columns == 2
                                                       ? GST_VIDEO_MULTIVIEW_MODE_SIDE_BY_SIDE
                                                       : GST_VIDEO_MULTIVIEW_MODE_TOP_BOTTOM);
}

/* Whether views of this size are squeezed to half their width or height: nearer to that than to their own
 * aspect. */
bool is_half(const LightFieldPlan &plan, double width, double height)
{
    const double squeezed = width / height * plan.output.height / plan.output.width;
    return plan.parameters.columns == 2 ? squeezed < std::sqrt(0.5) : squeezed > std::sqrt(2.0);
}

} // namespace

GstCaps *light_field_caps(const GstVideoInfo &color, const LightFieldPlan &plan)
{
    const bool is_rgb = GST_VIDEO_INFO_IS_RGB(&color);
    g_autofree gchar *text = g_strdup_printf("video/x-raw, format=(string){ %s%s" DFF_RGB_FORMATS " }",
                                             is_rgb ? GST_VIDEO_INFO_NAME(&color) : "", is_rgb ? ", " : "");
    GstCaps *caps = gst_caps_from_string(text);
    gst_caps_set_simple(caps, "width", G_TYPE_INT, static_cast<gint>(plan.output.width), "height", G_TYPE_INT,
                        static_cast<gint>(plan.output.height), "pixel-aspect-ratio", GST_TYPE_FRACTION, 1, 1,
                        "framerate", GST_TYPE_FRACTION, GST_VIDEO_INFO_FPS_N(&color),
                        GST_VIDEO_INFO_FPS_D(&color), nullptr);
    if (const char *mode = stereo_mode(plan.parameters))
        gst_caps_set_simple(caps, "multiview-mode", G_TYPE_STRING, mode, nullptr);
    if (plan.any_size)
        gst_caps_set_simple(caps, "width", GST_TYPE_INT_RANGE, 1, G_MAXINT, "height", GST_TYPE_INT_RANGE, 1,
                            G_MAXINT, nullptr);
    return caps;
}

GstCaps *fixate_light_field_caps(GstCaps *caps, const LightFieldPlan &plan)
{
    caps = gst_caps_make_writable(gst_caps_truncate(caps));
    GstStructure *structure = gst_caps_get_structure(caps, 0);
    gst_structure_fixate_field_nearest_int(structure, "width", static_cast<gint>(plan.output.width));
    gst_structure_fixate_field_nearest_int(structure, "height", static_cast<gint>(plan.output.height));
    gint width = 0, height = 0;
    if (stereo_mode(plan.parameters) && gst_structure_get_int(structure, "width", &width) &&
        gst_structure_get_int(structure, "height", &height) && is_half(plan, width, height))
        gst_structure_set(structure, "multiview-flags", GST_TYPE_VIDEO_MULTIVIEW_FLAGSET,
                          GST_VIDEO_MULTIVIEW_FLAGS_HALF_ASPECT, GST_FLAG_SET_MASK_EXACT, nullptr);
    return gst_caps_fixate(caps);
}

} // namespace dff
