/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_properties.h"

#define GST_TYPE_LENS_SWEEP_SRC_TRIGGER (gst_lens_sweep_src_trigger_get_type())

static GType gst_lens_sweep_src_trigger_get_type()
{
    using dff::TriggerKind;
    static const GEnumValue values[] = {
        {static_cast<int>(TriggerKind::Line), "Pulses on trigger-source, of the sequencer", "line"},
        {static_cast<int>(TriggerKind::Software), "Commands of this host, which moves the lens in step",
         "software"},
        {static_cast<int>(TriggerKind::FreeRun), "None: the camera runs at planes times rate", "free-run"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLensSweepSrcTrigger", values);
    return type;
}

namespace {

enum {
    PROP_CAMERA = PROP_STATS + 1,
    PROP_RATE,
    PROP_EXPOSURE,
    PROP_GAIN,
    PROP_TRIGGER,
    PROP_TRIGGER_SOURCE,
    PROP_TRIGGER_TIMEOUT,
    PROP_LENS,
    PROP_LENS_PROFILE,
    PROP_RUN_LINE,
    PROP_SYNC_LINE,
    PROP_FEATURES,
    PROP_CALIBRATION
};

std::string *text_property(dff::CaptureSettings &settings, guint id)
{
    switch (id) {
    case PROP_CAMERA:
        return &settings.camera;
    case PROP_TRIGGER_SOURCE:
        return &settings.trigger_source;
    case PROP_LENS:
        return &settings.lens;
    case PROP_LENS_PROFILE:
        return &settings.lens_profile;
    case PROP_RUN_LINE:
        return &settings.run_line;
    case PROP_SYNC_LINE:
        return &settings.sync_line;
    case PROP_FEATURES:
        return &settings.features;
    case PROP_CALIBRATION:
        return &settings.calibration;
    default:
        return nullptr;
    }
}

constexpr auto ready =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);
constexpr auto playing =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);

void install_texts(GObjectClass *klass)
{
    struct Text {
        guint id;
        const char *name;
        const char *nick;
        const char *blurb;
        const char *fallback;
    };
    static const Text texts[] = {
        {PROP_CAMERA, "camera", "Camera",
         "Id, serial number, MAC or IP address of the camera; the first one found if empty, Fake_1 for a "
         "simulated one",
         ""},
        {PROP_TRIGGER_SOURCE, "trigger-source", "Trigger source",
         "The camera's input that the sequencer is wired to, for trigger=line", "Line0"},
        {PROP_LENS, "lens", "Lens",
         "What moves the lens: fpga:DEVICE@ADDRESS, max14574:DEVICE@ADDRESS, genicam:FEATURE, v4l2:DEVICE, "
         "optotune:PORT, or none",
         "none"},
        {PROP_LENS_PROFILE, "lens-profile", "Lens profile",
         "YAML file of what the lens does at which voltage; the one shipped if empty", ""},
        {PROP_RUN_LINE, "run-line", "Run line",
         "GPIO line that starts the sequencer, by name or as gpiochip0:5; raised when the camera is ready",
         ""},
        {PROP_SYNC_LINE, "sync-line", "Sync line",
         "GPIO line on which the sequencer pulses at plane 0, by name or as gpiochip0:5", ""},
        {PROP_FEATURES, "features", "Features",
         "More features of the camera, set before it starts: \"Name=Value Name=Value\"", ""},
        {PROP_CALIBRATION, "calibration", "Calibration",
         "File of dff-calibrate that says where the planes are sharp, whatever near, far, powers or the lens "
         "say; "
         "empty: they say it",
         ""},
    };
    for (const Text &text : texts)
        g_object_class_install_property(
            klass, text.id, g_param_spec_string(text.name, text.nick, text.blurb, text.fallback, ready));
}

} // namespace

dff::CaptureSettings CameraProperties::settings() const
{
    dff::CaptureSettings settings = capture;
    settings.plan = sweep.plan();
    return settings;
}

void install_camera_properties(GObjectClass *klass)
{
    const CameraProperties defaults;
    const auto install = [klass](guint id, GParamSpec *spec) {
        g_object_class_install_property(klass, id, spec);
    };
    install_sweep_properties(klass);
    install_texts(klass);
    install(PROP_RATE, g_param_spec_double("rate", "Rate",
                                           "Sweeps per second; a sequencer has its own, and this says which",
                                           0.01, 1000.0, defaults.capture.rate, playing));
    install(PROP_EXPOSURE,
            g_param_spec_double("exposure", "Exposure", "Exposure time of a plane in microseconds", 1.0, 1e8,
                                defaults.capture.exposure_us, playing));
    install(PROP_GAIN,
            g_param_spec_double("gain", "Gain",
                                "Gain in the camera's unit, mostly dB; the camera's own until it is set",
                                -100.0, 10000.0, 0.0, playing));
    install(PROP_TRIGGER, g_param_spec_enum("trigger", "Trigger", "Who tells the camera to expose a plane",
                                            GST_TYPE_LENS_SWEEP_SRC_TRIGGER,
                                            static_cast<int>(defaults.capture.trigger), ready));
    install(PROP_TRIGGER_TIMEOUT,
            g_param_spec_uint64(
                "trigger-timeout", "Trigger timeout",
                "Nanoseconds without a frame that are an error; 18446744073709551615 (none): never", 1,
                GST_CLOCK_TIME_NONE, defaults.trigger_timeout, playing));
}

bool set_camera_property(CameraProperties &properties, guint id, const GValue *value)
{
    dff::CaptureSettings &capture = properties.capture;
    if (set_sweep_property(properties.sweep, id, value))
        return true;
    if (std::string *text = text_property(capture, id)) {
        const char *given = g_value_get_string(value);
        *text = given ? given : "";
        return true;
    }
    switch (id) {
    case PROP_RATE:
        capture.rate = g_value_get_double(value);
        return true;
    case PROP_EXPOSURE:
        capture.exposure_us = g_value_get_double(value);
        return true;
    case PROP_GAIN:
        capture.gain = g_value_get_double(value);
        return true;
    case PROP_TRIGGER:
        capture.trigger = static_cast<dff::TriggerKind>(g_value_get_enum(value));
        return true;
    case PROP_TRIGGER_TIMEOUT:
        properties.trigger_timeout = g_value_get_uint64(value);
        return true;
    default:
        return false;
    }
}

bool get_camera_property(const CameraProperties &properties, guint id, GValue *value)
{
    dff::CaptureSettings capture = properties.capture;
    if (get_sweep_property(properties.sweep, id, value))
        return true;
    if (const std::string *text = text_property(capture, id)) {
        g_value_set_string(value, text->c_str());
        return true;
    }
    switch (id) {
    case PROP_RATE:
        g_value_set_double(value, capture.rate);
        return true;
    case PROP_EXPOSURE:
        g_value_set_double(value, capture.exposure_us);
        return true;
    case PROP_GAIN:
        g_value_set_double(value, capture.gain.value_or(0.0));
        return true;
    case PROP_TRIGGER:
        g_value_set_enum(value, static_cast<int>(capture.trigger));
        return true;
    case PROP_TRIGGER_TIMEOUT:
        g_value_set_uint64(value, properties.trigger_timeout);
        return true;
    default:
        return false;
    }
}

void mark_camera_types()
{
    gst_type_mark_as_plugin_api(GST_TYPE_LENS_SWEEP_SRC_TRIGGER, static_cast<GstPluginAPIFlags>(0));
}
