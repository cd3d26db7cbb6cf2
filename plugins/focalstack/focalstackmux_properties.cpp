/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/focalstackmux_properties.h"

#include "common/checked_properties.h"

namespace dff {
namespace {

namespace property {
enum : guint { Planes = 1, OnMissing, Window, End };
} // namespace property
static_assert(property::End == mux_properties_end);

GType on_missing_get_type()
{
    static GType type;
    static const GEnumValue values[] = {
        {static_cast<int>(OnMissing::Drop), "Do not send the stack", "drop"},
        {static_cast<int>(OnMissing::Hold), "Take the plane of the last stack", "hold"},
        {static_cast<int>(OnMissing::Repeat), "Take the neighbouring plane of this sweep", "repeat"},
        {0, nullptr, nullptr},
    };
    if (g_once_init_enter(&type))
        g_once_init_leave(&type, g_enum_register_static("GstFocalStackMuxOnMissing", values));
    return type;
}

GType window_get_type()
{
    static GType type;
    static const GEnumValue values[] = {
        {static_cast<int>(StackWindow::Sweep), "One stack for each sweep", "sweep"},
        {static_cast<int>(StackWindow::Rolling), "A stack of the last planes at each frame", "rolling"},
        {0, nullptr, nullptr},
    };
    if (g_once_init_enter(&type))
        g_once_init_leave(&type, g_enum_register_static("GstFocalStackMuxWindow", values));
    return type;
}

} // namespace

void install_mux_properties(GObjectClass *object_class)
{
    gst_type_mark_as_plugin_api(on_missing_get_type(), static_cast<GstPluginAPIFlags>(0));
    gst_type_mark_as_plugin_api(window_get_type(), static_cast<GstPluginAPIFlags>(0));
    const auto settable =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);
    g_object_class_install_property(
        object_class, property::Planes,
        checked_at_start(g_param_spec_uint(
            "planes", "Planes", "Planes a stack, 2 to 64 (0: as the frames' metas or the pads say)", 0,
            GST_FOCAL_STACK_MAX_PLANES, 0, settable)));
    g_object_class_install_property(
        object_class, property::OnMissing,
        g_param_spec_enum(
            "on-missing", "On missing",
            "What becomes of a stack of which planes are missing; a sweep of which no frame came "
            "is always dropped",
            on_missing_get_type(), static_cast<int>(OnMissing::Drop), settable));
    g_object_class_install_property(object_class, property::Window,
                                    g_param_spec_enum("window", "Window", "Which frames make a stack",
                                                      window_get_type(), static_cast<int>(StackWindow::Sweep),
                                                      settable));
}

bool set_mux_property(MuxSettings &settings, guint id, const GValue *value)
{
    switch (id) {
    case property::Planes:
        settings.planes = g_value_get_uint(value);
        return true;
    case property::OnMissing:
        settings.on_missing = static_cast<OnMissing>(g_value_get_enum(value));
        return true;
    case property::Window:
        settings.window = static_cast<StackWindow>(g_value_get_enum(value));
        return true;
    default:
        return false;
    }
}

bool get_mux_property(const MuxSettings &settings, guint id, GValue *value)
{
    switch (id) {
    case property::Planes:
        g_value_set_uint(value, settings.planes);
        return true;
    case property::OnMissing:
        g_value_set_enum(value, static_cast<int>(settings.on_missing));
        return true;
    case property::Window:
        g_value_set_enum(value, static_cast<int>(settings.window));
        return true;
    default:
        return false;
    }
}

} // namespace dff
