/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_caps.h"

#include "camera/camera_control.h"

#include <algorithm>
#include <gst/video/video.h>
#include <numeric>
#include <vector>

namespace {

using dff::AravisCamera;
using dff::CameraExtent;
using dff::PixelLayout;

/* Bayer patterns are two pixels wide and high: converters crash at odd sizes. */
void set_extent(GstStructure *structure, const char *field, const CameraExtent &extent, bool even)
{
    const int step = even ? std::lcm(std::max(extent.step, 1), 2) : std::max(extent.step, 1);
    const int least = (std::max(extent.least, 1) + step - 1) / step * step;
    const int most = extent.most / step * step;
    g_auto(GValue) value = G_VALUE_INIT;
    if (least >= most) {
        gst_structure_set(structure, field, G_TYPE_INT, most, nullptr);
        return;
    }
    g_value_init(&value, GST_TYPE_INT_RANGE);
    gst_value_set_int_range_step(&value, least, most, step);
    gst_structure_set_value(structure, field, &value);
}

/* Layouts of the camera, its current one first. */
std::vector<const PixelLayout *> layouts_of(AravisCamera &camera)
{
    std::vector<const PixelLayout *> layouts;
    const std::string current = camera.pixel_format();
    const auto names = camera.pixel_formats();
    if (const PixelLayout *layout = dff::layout_of_camera(current))
        layouts.push_back(layout);
    for (const PixelLayout &layout : dff::pixel_layouts())
        if (layout.genicam != current && std::find(names.begin(), names.end(), layout.genicam) != names.end())
            layouts.push_back(&layout);
    return layouts;
}

} // namespace

GstCaps *camera_template_caps()
{
    return gst_caps_from_string(GST_VIDEO_CAPS_MAKE(
        "{ GRAY8, GRAY16_LE, RGB, BGR }") "; video/x-bayer, format={ rggb, "
                                          "grbg, gbrg, bggr }, width=" GST_VIDEO_SIZE_RANGE
                                          ", height=" GST_VIDEO_SIZE_RANGE
                                          ", framerate=" GST_VIDEO_FPS_RANGE);
}

GstCaps *camera_caps(AravisCamera &camera, double frame_rate)
{
    gint numerator = 0;
    gint denominator = 1;
    gst_util_double_to_fraction(frame_rate, &numerator, &denominator);
    const CameraExtent widths = camera.widths();
    const CameraExtent heights = camera.heights();
    GstCaps *caps = gst_caps_new_empty();
    for (const PixelLayout *layout : layouts_of(camera)) {
        GstStructure *structure =
            gst_structure_new(layout->media_type, "format", G_TYPE_STRING, layout->format, "framerate",
                              GST_TYPE_FRACTION, numerator, denominator, nullptr);
        set_extent(structure, "width", widths, layout->is_bayer());
        set_extent(structure, "height", heights, layout->is_bayer());
        caps = gst_caps_merge_structure(caps, structure);
    }
    if (!gst_caps_is_empty(caps))
        return caps;
    gst_caps_unref(caps);
    throw dff::CameraError(
        "this camera has no pixel format that can be used here: it needs one of Mono8, Mono10, "
        "Mono12, Mono16, Bayer with 8 bits, RGB8");
}

GstCaps *fixate_camera_caps(AravisCamera &camera, GstCaps *caps)
{
    const dff::CameraRegion region = camera.region();
    caps = gst_caps_make_writable(gst_caps_truncate(caps));
    GstStructure *structure = gst_caps_get_structure(caps, 0);
    const bool even = gst_structure_has_name(structure, "video/x-bayer");
    gst_structure_fixate_field_nearest_int(structure, "width", even ? region.width / 2 * 2 : region.width);
    gst_structure_fixate_field_nearest_int(structure, "height", even ? region.height / 2 * 2 : region.height);
    return gst_caps_fixate(caps);
}

CameraFormat format_of_caps(AravisCamera &camera, const GstCaps *caps)
{
    CameraFormat format;
    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    const char *name = gst_structure_get_string(structure, "format");
    gst_structure_get_int(structure, "width", &format.width);
    gst_structure_get_int(structure, "height", &format.height);
    for (const PixelLayout *layout : layouts_of(camera)) {
        if (name && gst_structure_has_name(structure, layout->media_type) &&
            g_str_equal(name, layout->format)) {
            format.layout = layout;
            break;
        }
    }
    return format;
}
