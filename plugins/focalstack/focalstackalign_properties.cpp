/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/focalstackalign_properties.h"

namespace dff {
namespace {

namespace property {
enum : guint { Mode = 1, Calibration, MotionModel, EvenBrightness, End };
} // namespace property
static_assert(property::End == align_properties_end);

GType align_mode_get_type()
{
    static GType type;
    static const GEnumValue values[] = {
        {static_cast<int>(AlignMode::Estimate), "Found anew in the pictures of each stack", "estimate"},
        {static_cast<int>(AlignMode::Calibration),
         "From the file calibration, for rigs that always do the same", "calibration"},
        {0, nullptr, nullptr},
    };
    if (g_once_init_enter(&type))
        g_once_init_leave(&type, g_enum_register_static("GstFocalStackAlignMode", values));
    return type;
}

GType motion_model_get_type()
{
    static GType type;
    static const GEnumValue values[] = {
        {static_cast<int>(MotionChoice::Auto),
         "Homographies where they explain clearly more, else similarities", "auto"},
        {static_cast<int>(MotionChoice::Similarity), "Shift, turn and zoom", "similarity"},
        {static_cast<int>(MotionChoice::Homography), "Perspective too, as a phone in the hand needs it",
         "homography"},
        {0, nullptr, nullptr},
    };
    if (g_once_init_enter(&type))
        g_once_init_leave(&type, g_enum_register_static("GstFocalStackAlignMotionModel", values));
    return type;
}

} // namespace

void install_align_properties(GObjectClass *object_class)
{
    constexpr auto settable =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);

    gst_type_mark_as_plugin_api(align_mode_get_type(), static_cast<GstPluginAPIFlags>(0));
    g_object_class_install_property(
        object_class, property::Mode,
        g_param_spec_enum("mode", "Mode", "Where the warp of each plane comes from", align_mode_get_type(),
                          static_cast<int>(AlignMode::Estimate), settable));
    g_object_class_install_property(
        object_class, property::Calibration,
        g_param_spec_string(
            "calibration", "Calibration",
            "File of mode=calibration (YAML): image_width, image_height, and planes, a list, nearest "
            "first, of dx and dy (pixels), scale and rotation (degrees), or of the matrix, as stats tells "
            "them",
            "", settable));
    gst_type_mark_as_plugin_api(motion_model_get_type(), static_cast<GstPluginAPIFlags>(0));
    g_object_class_install_property(
        object_class, property::MotionModel,
        g_param_spec_enum("motion-model", "Motion model",
                          "What mode=estimate takes to lie between the pictures of two planes",
                          motion_model_get_type(), static_cast<int>(MotionChoice::Auto), settable));
    g_object_class_install_property(
        object_class, property::EvenBrightness,
        g_param_spec_boolean(
            "even-brightness", "Even brightness",
            "Give all planes of a stack the same brightness and colour, by a gain and an offset "
            "a plane and channel: for photographs and lights that flicker",
            FALSE, settable));
}

bool set_align_property(AlignSettings &settings, guint id, const GValue *value)
{
    switch (id) {
    case property::Mode:
        settings.mode = static_cast<AlignMode>(g_value_get_enum(value));
        return true;
    case property::Calibration:
        settings.calibration = g_value_get_string(value) ? g_value_get_string(value) : "";
        return true;
    case property::MotionModel:
        settings.motion_model = static_cast<MotionChoice>(g_value_get_enum(value));
        return true;
    case property::EvenBrightness:
        settings.even_brightness = g_value_get_boolean(value);
        return true;
    default:
        return false;
    }
}

bool get_align_property(const AlignSettings &settings, guint id, GValue *value)
{
    switch (id) {
    case property::Mode:
        g_value_set_enum(value, static_cast<int>(settings.mode));
        return true;
    case property::Calibration:
        g_value_set_string(value, settings.calibration.c_str());
        return true;
    case property::MotionModel:
        g_value_set_enum(value, static_cast<int>(settings.motion_model));
        return true;
    case property::EvenBrightness:
        g_value_set_boolean(value, settings.even_brightness);
        return true;
    default:
        return false;
    }
}

} // namespace dff
