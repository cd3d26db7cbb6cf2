/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "tag_settings.h"

#include "common/checked_properties.h"

#include <gst/gst.h>

namespace {

enum {
    PROP_MODE = FIRST_OWN_PROPERTY,
    PROP_LENS,
    PROP_LENS_PROFILE,
    PROP_SETTLE_FRAMES,
    PROP_SYNC_LINE,
    PROP_TIMESTAMP_DELAY,
    PROP_POSITIONS,
    PROP_STEP_UM,
    PROP_CALIBRATION,
};

constexpr auto flags =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);

void install_string(GObjectClass *klass, guint id, const char *name, const char *nick, const char *blurb,
                    const char *value)
{
    g_object_class_install_property(klass, id, g_param_spec_string(name, nick, blurb, value, flags));
}

/* Micrometres: a stage of ten metres is none. */
constexpr gdouble farthest_position = 1e7;

void install_stage_properties(GObjectClass *klass, const StagePositions &defaults)
{
    g_object_class_install_property(
        klass, PROP_POSITIONS,
        gst_param_spec_array("positions", "Positions",
                             "Where a microscope's stage stands in each plane, in micrometres, all rising or "
                             "all falling, that of the nearest plane first; replaces planes unless empty",
                             g_param_spec_double("position", "Position", "Stage position in micrometres",
                                                 -farthest_position, farthest_position, 0.0, flags),
                             flags));
    g_object_class_install_property(
        klass, PROP_STEP_UM,
        dff::checked_at_start(g_param_spec_double(
            "step-um", "Step",
            "How far a microscope's stage moves from plane to plane, in micrometres; plane 0 "
            "is at 0; 0: positions are not known, or are those of positions",
            -farthest_position, farthest_position, defaults.step_um, flags)));
}

std::string text_of(const GValue *value)
{
    const gchar *text = g_value_get_string(value);
    return text ? text : "";
}

} // namespace

GType gst_lens_sweep_tag_mode_get_type()
{
    static const GEnumValue values[] = {
        {GST_LENS_SWEEP_TAG_MODE_CYCLE, "The lens cycles by itself; frames are counted", "cycle"},
        {GST_LENS_SWEEP_TAG_MODE_STEP,
         "The lens is moved a plane at a time; frames that saw it move are dropped", "step"},
        {GST_LENS_SWEEP_TAG_MODE_SYNC,
         "The lens sweeps by itself; edges of the sync line tell where plane 0 is", "sync"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLensSweepTagMode", values);
    return type;
}

void install_tag_properties(GObjectClass *klass)
{
    const TagSettings defaults;
    install_sweep_properties(klass, defaults.sweep);
    g_object_class_install_property(klass, PROP_MODE,
                                    g_param_spec_enum("mode", "Mode", "How the plane of a frame is found",
                                                      gst_lens_sweep_tag_mode_get_type(), defaults.mode,
                                                      flags));
    install_string(klass, PROP_LENS, "lens", "Lens",
                   "The lens that is moved (step) or started (sync): element:cam.lens-position, "
                   "v4l2:/dev/video0, optotune:/dev/ttyACM0, "
                   "max14574:/dev/i2c-1@0x77, fpga:/dev/i2c-1@0x3c, or none",
                   defaults.lens.c_str());
    install_string(
        klass, PROP_LENS_PROFILE, "lens-profile", "Lens profile",
        "YAML file that gives the voltages of a liquid lens (empty: nominal Varioptic C-C-39N0-250), or the "
        "positions of another lens at two or more vergences",
        defaults.lens_profile.c_str());
    g_object_class_install_property(
        klass, PROP_SETTLE_FRAMES,
        dff::checked_at_start(g_param_spec_uint(
            "settle-frames", "Settle frames",
            "mode=step: frames dropped after each move in addition to those known to have seen it; with "
            "lens=element: they are counted from the frame for which the camera says that its lens is there",
            0, 1000, defaults.settle_frames, flags)));
    install_string(klass, PROP_SYNC_LINE, "sync-line", "Sync line",
                   "mode=sync: the GPIO line with an edge at each plane 0, by name or as gpiochip0:5",
                   defaults.sync_line.c_str());
    g_object_class_install_property(
        klass, PROP_TIMESTAMP_DELAY,
        g_param_spec_uint64(
            "timestamp-delay", "Timestamp delay",
            "mode=sync: time in ns from the begin of a frame's exposure to its timestamp; drivers "
            "that stamp a frame when it was read out need the exposure and the readout here",
            0, 10 * GST_SECOND, defaults.timestamp_delay_ns, flags));
    install_stage_properties(klass, defaults.stage);
    install_string(
        klass, PROP_CALIBRATION, "calibration", "Calibration",
        "File of dff-calibrate that says where the planes are sharp, whatever near, far, powers or the "
        "lens say; empty: they say it",
        defaults.calibration.c_str());
}

bool set_tag_property(TagSettings &settings, guint id, const GValue *value)
{
    switch (id) {
    case PROP_MODE:
        settings.mode = static_cast<GstLensSweepTagMode>(g_value_get_enum(value));
        return true;
    case PROP_LENS:
        settings.lens = text_of(value);
        return true;
    case PROP_LENS_PROFILE:
        settings.lens_profile = text_of(value);
        return true;
    case PROP_SETTLE_FRAMES:
        settings.settle_frames = g_value_get_uint(value);
        return true;
    case PROP_SYNC_LINE:
        settings.sync_line = text_of(value);
        return true;
    case PROP_TIMESTAMP_DELAY:
        settings.timestamp_delay_ns = g_value_get_uint64(value);
        return true;
    case PROP_POSITIONS:
        settings.stage.positions_um = numbers_of(value);
        return true;
    case PROP_STEP_UM:
        settings.stage.step_um = g_value_get_double(value);
        return true;
    case PROP_CALIBRATION:
        settings.calibration = text_of(value);
        return true;
    default:
        return set_sweep_property(settings.sweep, id, value);
    }
}

bool get_tag_property(const TagSettings &settings, guint id, GValue *value)
{
    switch (id) {
    case PROP_MODE:
        g_value_set_enum(value, settings.mode);
        return true;
    case PROP_LENS:
        g_value_set_string(value, settings.lens.c_str());
        return true;
    case PROP_LENS_PROFILE:
        g_value_set_string(value, settings.lens_profile.c_str());
        return true;
    case PROP_SETTLE_FRAMES:
        g_value_set_uint(value, settings.settle_frames);
        return true;
    case PROP_SYNC_LINE:
        g_value_set_string(value, settings.sync_line.c_str());
        return true;
    case PROP_TIMESTAMP_DELAY:
        g_value_set_uint64(value, settings.timestamp_delay_ns);
        return true;
    case PROP_POSITIONS:
        put_numbers(value, settings.stage.positions_um);
        return true;
    case PROP_STEP_UM:
        g_value_set_double(value, settings.stage.step_um);
        return true;
    case PROP_CALIBRATION:
        g_value_set_string(value, settings.calibration.c_str());
        return true;
    default:
        return get_sweep_property(settings.sweep, id, value);
    }
}
