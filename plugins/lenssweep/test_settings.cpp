/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_settings.h"

#include "common/checked_properties.h"

#include <gst/gst.h>

namespace {

enum {
    PROP_RATE = FIRST_OWN_PROPERTY,
    PROP_SCENE,
    PROP_IMAGE,
    PROP_DEPTH_MAP,
    PROP_BLUR_STEP,
    PROP_NOISE,
    PROP_MOTION,
    PROP_BREATHING,
    PROP_JITTER,
    PROP_SEED,
    PROP_FLICKER,
    PROP_LIGHT_SWITCH,
    PROP_IS_LIVE,
    PROP_NUM_BUFFERS,
    PROP_BOARD,
    PROP_POSE,
    PROP_CALIBRATION,
    PROP_FIELD_CURVATURE,
    PROP_OBJECTS,
    PROP_FROZEN,
    PROP_PAN,
    PROP_SHAKE,
    PROP_CUT,
    PROP_VIGNETTING,
};

void set_string(std::string &target, const GValue *value)
{
    const gchar *text = g_value_get_string(value);
    target = text ? text : "";
}

/* False if the id is not one of the scene's. */
bool set_scene_property(TestScene &scene, guint id, const GValue *value)
{
    switch (id) {
    case PROP_SCENE:
        scene.scene = static_cast<GstLensSweepTestScene>(g_value_get_enum(value));
        return true;
    case PROP_IMAGE:
        set_string(scene.image, value);
        return true;
    case PROP_DEPTH_MAP:
        set_string(scene.depth_map, value);
        return true;
    case PROP_BOARD:
        set_string(scene.board, value);
        return true;
    case PROP_POSE:
        set_string(scene.pose, value);
        return true;
    case PROP_CALIBRATION:
        set_string(scene.calibration, value);
        return true;
    case PROP_FIELD_CURVATURE:
        scene.field_curvature = g_value_get_double(value);
        return true;
    case PROP_VIGNETTING:
        scene.vignetting = g_value_get_double(value);
        return true;
    case PROP_BLUR_STEP:
        scene.blur_step = g_value_get_double(value);
        return true;
    case PROP_NOISE:
        set_string(scene.noise, value);
        return true;
    case PROP_MOTION:
        scene.motion = g_value_get_double(value);
        return true;
    case PROP_BREATHING:
        scene.breathing = g_value_get_double(value);
        return true;
    case PROP_JITTER:
        scene.jitter = g_value_get_double(value);
        return true;
    case PROP_SEED:
        scene.seed = g_value_get_uint64(value);
        return true;
    case PROP_FLICKER:
        scene.flicker = g_value_get_double(value);
        return true;
    case PROP_LIGHT_SWITCH:
        scene.light_switch = g_value_get_uint(value);
        return true;
    case PROP_OBJECTS:
        scene.objects = g_value_get_flags(value);
        return true;
    case PROP_FROZEN:
        scene.frozen = g_value_get_boolean(value);
        return true;
    case PROP_PAN:
        scene.pan = g_value_get_double(value);
        return true;
    case PROP_SHAKE:
        scene.shake = g_value_get_double(value);
        return true;
    case PROP_CUT:
        scene.cut = g_value_get_uint(value);
        return true;
    default:
        return false;
    }
}

bool get_scene_property(const TestScene &scene, guint id, GValue *value)
{
    switch (id) {
    case PROP_SCENE:
        g_value_set_enum(value, scene.scene);
        return true;
    case PROP_IMAGE:
        g_value_set_string(value, scene.image.c_str());
        return true;
    case PROP_DEPTH_MAP:
        g_value_set_string(value, scene.depth_map.c_str());
        return true;
    case PROP_BOARD:
        g_value_set_string(value, scene.board.c_str());
        return true;
    case PROP_POSE:
        g_value_set_string(value, scene.pose.c_str());
        return true;
    case PROP_CALIBRATION:
        g_value_set_string(value, scene.calibration.c_str());
        return true;
    case PROP_FIELD_CURVATURE:
        g_value_set_double(value, scene.field_curvature);
        return true;
    case PROP_VIGNETTING:
        g_value_set_double(value, scene.vignetting);
        return true;
    case PROP_BLUR_STEP:
        g_value_set_double(value, scene.blur_step);
        return true;
    case PROP_NOISE:
        g_value_set_string(value, scene.noise.c_str());
        return true;
    case PROP_MOTION:
        g_value_set_double(value, scene.motion);
        return true;
    case PROP_BREATHING:
        g_value_set_double(value, scene.breathing);
        return true;
    case PROP_JITTER:
        g_value_set_double(value, scene.jitter);
        return true;
    case PROP_SEED:
        g_value_set_uint64(value, scene.seed);
        return true;
    case PROP_FLICKER:
        g_value_set_double(value, scene.flicker);
        return true;
    case PROP_LIGHT_SWITCH:
        g_value_set_uint(value, scene.light_switch);
        return true;
    case PROP_OBJECTS:
        g_value_set_flags(value, scene.objects);
        return true;
    case PROP_FROZEN:
        g_value_set_boolean(value, scene.frozen);
        return true;
    case PROP_PAN:
        g_value_set_double(value, scene.pan);
        return true;
    case PROP_SHAKE:
        g_value_set_double(value, scene.shake);
        return true;
    case PROP_CUT:
        g_value_set_uint(value, scene.cut);
        return true;
    default:
        return false;
    }
}

} // namespace

bool set_test_property(TestSettings &settings, guint id, const GValue *value)
{
    switch (id) {
    case PROP_RATE:
        settings.rate = g_value_get_double(value);
        return true;
    case PROP_IS_LIVE:
        settings.is_live = g_value_get_boolean(value);
        return true;
    case PROP_NUM_BUFFERS:
        settings.num_buffers = g_value_get_int(value);
        return true;
    default:
        return set_scene_property(settings.scene, id, value) || set_sweep_property(settings.sweep, id, value);
    }
}

bool get_test_property(const TestSettings &settings, guint id, GValue *value)
{
    switch (id) {
    case PROP_RATE:
        g_value_set_double(value, settings.rate);
        return true;
    case PROP_IS_LIVE:
        g_value_set_boolean(value, settings.is_live);
        return true;
    case PROP_NUM_BUFFERS:
        g_value_set_int(value, settings.num_buffers);
        return true;
    default:
        return get_scene_property(settings.scene, id, value) || get_sweep_property(settings.sweep, id, value);
    }
}

static void install_motion_properties(GObjectClass *klass, const TestScene &defaults)
{
    constexpr auto playing =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
    const auto install = [klass](guint id, GParamSpec *spec) {
        g_object_class_install_property(klass, id, spec);
    };
    const auto install_range = [&](guint id, GParamSpec *spec) { install(id, dff::checked_at_start(spec)); };
    install_range(
        PROP_MOTION,
        g_param_spec_double("motion", "Motion",
                            "Pixels that the objects, which fly from side to side before the scene, move "
                            "from plane to plane (negative: they begin on the other side); 0: there are none",
                            -1000.0, 1000.0, defaults.motion, playing));
    install(PROP_OBJECTS, g_param_spec_flags("objects", "Objects", "What flies before the scene, with motion",
                                             GST_TYPE_LENS_SWEEP_TEST_OBJECTS, defaults.objects, playing));
    install_range(PROP_PAN,
                  g_param_spec_double("pan", "Pan",
                                      "Pixels that the camera turns to the right by from plane to plane; "
                                      "beyond its borders the scene goes on as its mirror image",
                                      -1000.0, 1000.0, defaults.pan, playing));
    install_range(
        PROP_SHAKE,
        g_param_spec_double("shake", "Shake",
                            "Root mean square of the camera's shake along x and y, in pixels: smooth waves "
                            "of 15 to 40 planes, as of a hand, that go on from sweep to sweep",
                            0.0, 100.0, defaults.shake, playing));
    install(PROP_FROZEN,
            g_param_spec_boolean("frozen", "Frozen",
                                 "Objects and camera stand still while a sweep is taken, where they are in "
                                 "the middle of it: what motion compensation is measured by",
                                 defaults.frozen, playing));
    install_range(
        PROP_CUT,
        g_param_spec_uint("cut", "Cut",
                          "Frames after which the scene is shown upside down, and after as many again as "
                          "before; 0: there is no cut",
                          0, G_MAXUINT, defaults.cut, playing));
}

static void install_board_properties(GObjectClass *klass, const TestScene &defaults)
{
    constexpr auto playing =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
    const auto install = [klass](guint id, GParamSpec *spec) {
        g_object_class_install_property(klass, id, spec);
    };
    install(PROP_BOARD,
            g_param_spec_string("board", "Board",
                                "scene=board: squares of the chessboard in a row and in a column, and "
                                "the side of one in millimetres, as 10x7x25; around it is a border as "
                                "wide as a square",
                                defaults.board.c_str(), playing));
    install(PROP_POSE,
            g_param_spec_string("pose", "Pose",
                                "scene=board: where the middle of the board is, X,Y,Z in metres right, "
                                "down and away, and how it is turned about these axes one after the "
                                "other, in degrees: 0,0,0.5,20,0,0",
                                defaults.pose.c_str(), playing));
    install(
        PROP_CALIBRATION,
        g_param_spec_string("calibration", "Calibration",
                            "scene=board: file of the camera's calibration, as dffdepth has it, with which "
                            "the board is seen; empty: a focal length of 1.25 widths, without distortion",
                            defaults.calibration.c_str(), playing));
    install(
        PROP_FIELD_CURVATURE,
        dff::checked_at_start(g_param_spec_double(
            "field-curvature", "Field curvature",
            "Planes that what is sharp in the picture's corners lies farther away than what is sharp in its "
            "centre; grows with the square of the distance from the centre",
            -10.0, 10.0, defaults.field_curvature, playing)));
    install(PROP_VIGNETTING,
            dff::checked_at_start(g_param_spec_double("vignetting", "Vignetting",
                                                      "Share of the light that the picture's corners lose, "
                                                      "in every plane; grows with the square of the "
                                                      "distance from the centre",
                                                      0.0, 1.0, defaults.vignetting, playing)));
}

void install_test_properties(GObjectClass *klass)
{
    constexpr auto ready =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);
    /* Changes are seen from the next sweep on. */
    constexpr auto playing =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
    const TestSettings defaults;

    install_sweep_properties(klass);
    const auto install = [klass](guint id, GParamSpec *spec) {
        g_object_class_install_property(klass, id, spec);
    };
    const auto install_range = [&](guint id, GParamSpec *spec) { install(id, dff::checked_at_start(spec)); };
    install_range(PROP_RATE, g_param_spec_double("rate", "Rate", "Sweeps per second", 0.01, 1000.0,
                                                 defaults.rate, ready));
    install(PROP_SCENE, g_param_spec_enum("scene", "Scene", "What stands before the camera",
                                          GST_TYPE_LENS_SWEEP_TEST_SCENE, defaults.scene.scene, playing));
    install(PROP_IMAGE,
            g_param_spec_string("image", "Image", "Path of the sharp picture for scene=files", "", playing));
    install(PROP_DEPTH_MAP,
            g_param_spec_string("depth-map", "Depth map",
                                "Path of the disparity map for scene=files: one channel of 8 or 16 bits, the "
                                "image's size, larger is nearer, 0 is unknown; the 0.2 and 99.8 percentiles "
                                "become the ends of the sweep",
                                "", playing));
    install_range(PROP_BLUR_STEP,
                  g_param_spec_double(
                      "blur-step", "Blur step",
                      "Change of the circle of confusion's diameter from plane to plane, in pixels; -1: "
                      "10 pixels over the sweep, but 2 a plane at most",
                      -1.0, 100.0, defaults.scene.blur_step, playing));
    install(PROP_NOISE,
            g_param_spec_string("noise", "Noise",
                                "Noise of the sensor: none, mild (0.05,1), moderate (0.2,2), strong (1,5) or "
                                "GAIN,READ for the variance GAIN * value + READ^2 of 8-bit values",
                                defaults.scene.noise.c_str(), playing));
    install_range(
        PROP_BREATHING,
        g_param_spec_double(
            "breathing", "Breathing",
            "Magnification of the last plane less that of the first, about the picture's centre; 1 at plane "
            "planes / 2, as the true depth has it",
            -0.5, 0.5, defaults.scene.breathing, playing));
    install_range(PROP_JITTER,
                  g_param_spec_double("jitter", "Jitter",
                                      "Root mean square of each plane's shift along x and y, in pixels", 0.0,
                                      100.0, defaults.scene.jitter, playing));
    install_range(
        PROP_FLICKER,
        g_param_spec_double("flicker", "Flicker",
                            "Amplitude of the light's flicker over its mean, at 100 Hz as lamps have it "
                            "on mains of 50 Hz; each frame has the mean over its exposure",
                            0.0, 1.0, defaults.scene.flicker, playing));
    install_range(
        PROP_LIGHT_SWITCH,
        g_param_spec_uint("light-switch", "Light switch",
                          "Frames after which the light is dimmed to half, and after as many again to "
                          "full; 0: it is not switched",
                          0, G_MAXUINT, defaults.scene.light_switch, playing));
    install(PROP_SEED, g_param_spec_uint64("seed", "Seed", "Of textures, noise and jitter", 0, G_MAXUINT64,
                                           defaults.scene.seed, playing));
    install(PROP_IS_LIVE, g_param_spec_boolean("is-live", "Is live", "Send each frame when its exposure ends",
                                               defaults.is_live, ready));
    install_range(PROP_NUM_BUFFERS,
                  g_param_spec_int("num-buffers", "Number of buffers",
                                   "Frames to send before the end of the stream; -1 is no end", -1, G_MAXINT,
                                   defaults.num_buffers, ready));
    install_motion_properties(klass, defaults.scene);
    install_board_properties(klass, defaults.scene);
}
