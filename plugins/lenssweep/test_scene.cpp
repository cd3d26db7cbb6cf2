/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_scene.h"

#include "engine/scene/scene_board.h"
#include "engine/scene/scene_files.h"
#include "engine/scene/scene_shapes.h"
#include "engine/scene/scene_slant.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace {

/* The blur between planes takes the time to render, and the depth does not become better by more of it. */
constexpr gdouble blur_of_all = 10.0;
constexpr gdouble most_blur_a_plane = 2.0;

dff::SensorNoise parse_noise(const std::string &text)
{
    const auto noise = dff::SensorNoise::parse(text);
    if (!noise)
        throw std::invalid_argument("noise \"" + text +
                                    "\" is not known; use none, mild, moderate, strong or GAIN,READ "
                                    "(two numbers from 0 to 255, such as 0.2,2)");
    return *noise;
}

dff::BoardSheet parse_board(const std::string &text)
{
    const auto sheet = dff::BoardSheet::parse(text);
    if (!sheet)
        throw std::invalid_argument("board \"" + text +
                                    "\" is not known; use COLUMNSxROWSxMILLIMETRES, such as 10x7x25");
    return *sheet;
}

dff::BoardPose parse_pose(const std::string &text)
{
    const auto pose = dff::BoardPose::parse(text);
    if (!pose)
        throw std::invalid_argument("pose \"" + text +
                                    "\" is not known; use X,Y,Z in metres, Z above 0, or X,Y,Z,RX,RY,RZ "
                                    "with degrees, such as 0,0,0.5,20,0,0");
    return *pose;
}

/* A lens of some 44 degrees, unless a file says what it is. */
dff::CameraCalibration camera_of(const std::string &file, cv::Size size)
{
    const auto width = static_cast<unsigned>(size.width), height = static_cast<unsigned>(size.height);
    if (!file.empty())
        return dff::read_camera_calibration(file).scaled_to(width, height);
    const double focal_length = 1.25 * size.width;
    return {.width = width,
            .height = height,
            .fx = focal_length,
            .fy = focal_length,
            .cx = (size.width - 1) / 2.0,
            .cy = (size.height - 1) / 2.0};
}

dff::Scene upside_down(const dff::Scene &scene)
{
    dff::Scene turned;
    cv::rotate(scene.color, turned.color, cv::ROTATE_180);
    cv::rotate(scene.depth, turned.depth, cv::ROTATE_180);
    if (!scene.known.empty())
        cv::rotate(scene.known, turned.known, cv::ROTATE_180);
    return turned;
}

} // namespace

GType gst_lens_sweep_test_scene_get_type()
{
    static const GEnumValue values[] = {
        {GST_LENS_SWEEP_TEST_SCENE_SHAPES, "Balls, blocks and pillars on a slanted ground", "shapes"},
        {GST_LENS_SWEEP_TEST_SCENE_SLANT, "One slanted textured plane", "slant"},
        {GST_LENS_SWEEP_TEST_SCENE_FILES, "The files of image and depth-map", "files"},
        {GST_LENS_SWEEP_TEST_SCENE_BOARD, "A chessboard: board, pose and calibration", "board"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLensSweepTestScene", values);
    return type;
}

GType gst_lens_sweep_test_objects_get_type()
{
    using dff::MovingKind;
    static const GFlagsValue values[] = {
        {static_cast<guint>(MovingKind::Ball), "A ball that flies to the right", "ball"},
        {static_cast<guint>(MovingKind::Crossing), "A ball behind it that comes the other way", "crossing"},
        {static_cast<guint>(MovingKind::Turning), "A block that turns while it flies", "turning"},
        {static_cast<guint>(MovingKind::Nearing), "A ball that comes nearer while it flies", "nearing"},
        {static_cast<guint>(MovingKind::Plain), "A disk without texture", "plain"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_flags_register_static("GstLensSweepTestObjects", values);
    return type;
}

void TestScene::check() const
{
    parse_noise(noise);
    parse_board(board);
    parse_pose(pose);
    if (blur_step < 0.0 && blur_step != blur_of_sweep)
        throw std::invalid_argument("blur-step is 0 to 100 pixels, or -1");
    if (scene == GST_LENS_SWEEP_TEST_SCENE_FILES && (image.empty() || depth_map.empty()))
        throw std::invalid_argument(
            "scene=files needs the properties image and depth-map: the paths of a sharp "
            "picture and of its disparity map");
}

std::optional<cv::Size> TestScene::natural_size() const
{
    if (scene != GST_LENS_SWEEP_TEST_SCENE_FILES)
        return std::nullopt;
    return dff::image_size(image);
}

dff::Scene TestScene::make(const dff::SweepPlan &plan, cv::Size size, const std::stop_token &stop) const
{
    switch (scene) {
    case GST_LENS_SWEEP_TEST_SCENE_SLANT:
        return dff::make_slant(size, seed);
    case GST_LENS_SWEEP_TEST_SCENE_FILES:
        return dff::resize_scene(dff::load_scene(image, depth_map), size);
    case GST_LENS_SWEEP_TEST_SCENE_BOARD:
        return dff::make_board(parse_board(board), parse_pose(pose), camera_of(calibration, size), plan);
    default:
        return dff::make_shapes(size, seed, stop);
    }
}

dff::SweptCamera TestScene::camera(const dff::SweepPlan &plan, cv::Size size, const std::stop_token &stop,
                                   bool turned) const
{
    check();
    const gdouble step = blur_step == blur_of_sweep
                             ? std::min(most_blur_a_plane, blur_of_all / (plan.planes() - 1.0))
                             : blur_step;
    const dff::SweptCameraSettings settings{.plan = plan,
                                            .blur_step = step,
                                            .noise = parse_noise(noise),
                                            .motion = motion,
                                            .objects = objects,
                                            .frozen = frozen != FALSE,
                                            .pan = pan,
                                            .shake = shake,
                                            .breathing = breathing,
                                            .field_curvature = field_curvature,
                                            .vignetting = vignetting,
                                            .jitter = jitter,
                                            .seed = seed};
    dff::Scene seen = make(plan, size, stop);
    if (turned)
        seen = upside_down(seen);
    return {std::move(seen), settings, stop};
}
