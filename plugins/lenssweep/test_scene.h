/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/scene_light.h"
#include "engine/scene/swept_camera.h"

#include <glib-object.h>
#include <optional>
#include <stop_token>
#include <string>

enum GstLensSweepTestScene {
    GST_LENS_SWEEP_TEST_SCENE_SHAPES,
    GST_LENS_SWEEP_TEST_SCENE_SLANT,
    GST_LENS_SWEEP_TEST_SCENE_FILES,
    GST_LENS_SWEEP_TEST_SCENE_BOARD,
};

#define GST_TYPE_LENS_SWEEP_TEST_SCENE (gst_lens_sweep_test_scene_get_type())
GType gst_lens_sweep_test_scene_get_type();

/* Bits of dff::MovingKind. */
#define GST_TYPE_LENS_SWEEP_TEST_OBJECTS (gst_lens_sweep_test_objects_get_type())
GType gst_lens_sweep_test_objects_get_type();

/* A blur-step by which the whole sweep has 10 pixels, but no plane more than 2. */
constexpr gdouble blur_of_sweep = -1.0;

/* What stands before the simulated camera, and how it sees it: the properties of the same names. */
struct TestScene {
    GstLensSweepTestScene scene = GST_LENS_SWEEP_TEST_SCENE_SHAPES;
    std::string image;
    std::string depth_map;
    std::string board = "10x7x25";
    std::string pose = "0,0,0.5";
    std::string calibration;
    gdouble blur_step = blur_of_sweep; /* pixels from plane to plane */
    std::string noise = "none";
    gdouble motion = 0.0;
    guint objects = static_cast<guint>(dff::MovingKind::Ball); /* GstLensSweepTestObjects */
    gboolean frozen = FALSE;
    gdouble pan = 0.0;
    gdouble shake = 0.0;
    gdouble breathing = 0.0;
    gdouble field_curvature = 0.0;
    gdouble vignetting = 0.0;
    gdouble jitter = 0.0;
    gdouble flicker = 0.0;
    guint light_switch = 0;
    guint cut = 0;
    guint64 seed = 0;

    dff::SceneLight light() const { return {.flicker = flicker, .switch_frames = light_switch}; }

    bool operator==(const TestScene &) const = default;

    /* Throws std::invalid_argument or std::runtime_error, with a message for the user, if a property cannot
     * be used. Reads no file. */
    void check() const;

    /* The size of the image, or nothing for scenes that are made at any size; throws if it cannot be read. */
    std::optional<cv::Size> natural_size() const;

    /* Whether a frame shows the scene turned upside down. */
    bool is_turned(guint64 frame) const { return cut > 0 && frame / cut % 2 == 1; }

    /* Throws like check(), and if a file cannot be read. Unusable where `stop` was requested. */
    dff::SweptCamera camera(const dff::SweepPlan &plan, cv::Size size, const std::stop_token &stop,
                            bool turned = false) const;

private:
    dff::Scene make(const dff::SweepPlan &plan, cv::Size size, const std::stop_token &stop) const;
};
