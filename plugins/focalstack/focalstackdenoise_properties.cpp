/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/focalstackdenoise_properties.h"

namespace dff {

namespace {

enum Property : guint { PropertyFrames = 1, PropertyStrength, PropertyLocalMotion, PropertyDevice };

} // namespace

void install_denoise_properties(GObjectClass *object_class)
{
    const auto playing =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
    const auto ready =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);
    g_object_class_install_property(
        object_class, PropertyFrames,
        g_param_spec_uint("frames", "Frames",
                          "Sweeps that are averaged at most; 1 leaves the stacks as they are", 1, 255, 8,
                          playing));
    g_object_class_install_property(
        object_class, PropertyStrength,
        g_param_spec_double(
            "strength", "Strength",
            "How much change from sweep to sweep passes for noise: 1 is six standard deviations of "
            "it; less sees fainter motion, more averages where noise is uneven",
            0.25, 4.0, 1.0, playing));
    g_object_class_install_property(
        object_class, PropertyLocalMotion,
        g_param_spec_boolean("local-motion", "Local motion",
                             "Shows what moves during the sweep in all planes where it is in the middle of "
                             "the sweep, before what stood still in the sweeps before",
                             FALSE, playing));
    g_object_class_install_property(
        object_class, PropertyDevice,
        g_param_spec_string(
            "device", "Device",
            "Part of the name of the OpenCL device to compute on, as clinfo -l lists it; empty takes "
            "the first GPU, else the first device",
            "", ready));
}

bool set_denoise_property(DenoiseSettings &settings, guint id, const GValue *value)
{
    if (id == PropertyFrames)
        settings.parameters.frames = g_value_get_uint(value);
    else if (id == PropertyStrength)
        settings.parameters.strength = static_cast<float>(g_value_get_double(value));
    else if (id == PropertyLocalMotion)
        settings.local_motion = g_value_get_boolean(value);
    else if (id == PropertyDevice)
        settings.device = g_value_get_string(value) ? g_value_get_string(value) : "";
    else
        return false;
    return true;
}

bool get_denoise_property(const DenoiseSettings &settings, guint id, GValue *value)
{
    if (id == PropertyFrames)
        g_value_set_uint(value, settings.parameters.frames);
    else if (id == PropertyStrength)
        g_value_set_double(value, static_cast<double>(settings.parameters.strength));
    else if (id == PropertyLocalMotion)
        g_value_set_boolean(value, settings.local_motion);
    else if (id == PropertyDevice)
        g_value_set_string(value, settings.device.c_str());
    else
        return false;
    return true;
}

} // namespace dff
