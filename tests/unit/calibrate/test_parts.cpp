/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "calibration_file.h"
#include "coverage.h"
#include "focus_curves.h"
#include "lens_points.h"
#include "lens_profile_file.h"
#include "optics/focus_calibration.h"
#include "optics/focus_points.h"
#include "optics/lens_profile.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <unistd.h>

using namespace dff;

namespace {

const Board board{10, 7, 20.0};
const CameraCalibration camera{640, 480, 800.0, 800.0, 321.0, 237.0, {-0.05, 0.01, 0.0, 0.0, 0.0}};
constexpr unsigned planes = 6;

/* Where the board is, in metres and radians. */
struct Pose {
    cv::Vec3d turn, shift;
};

std::vector<Pose> good_poses()
{
    std::vector<Pose> poses;
    for (int k = 0; k < 12; k++) {
        const double z = 1.0 / (3.3 - 0.22 * k), side = 0.1 * z;
        poses.push_back({{0.45 * std::cos(2.0 * k), 0.45 * std::sin(2.0 * k), 0.1},
                         {-0.08 + side * std::cos(1.3 * k), -0.05 + side * std::sin(1.3 * k), z}});
    }
    return poses;
}

/* Plane z is in focus at 3.4 - 0.54 z dioptres in the centre and 0.27 less in the corners; each is 0.6 %
 * larger than the one before, and shifted. */
struct Lens {
    double growth = 0.006, shift = 0.3, near = 3.4, step = 0.54, field = -0.27;

    cv::Point2d seen(cv::Point2d pixel, unsigned plane) const
    {
        const cv::Point2d center(319.5, 239.5);
        const double off = plane - 3.0;
        return center + (1.0 + growth * off) * (pixel - center) + cv::Point2d(shift * off, 0.0);
    }
    double focus(double vergence, cv::Point2d pixel) const
    {
        const cv::Point2d at = pixel - cv::Point2d(319.5, 239.5);
        return (near + field * at.ddot(at) / 159500.5 - vergence) / step;
    }
};

BoardView view_of(const Pose &pose, const Lens &lens = {})
{
    const std::vector<cv::Point3f> sheet = board.corner_points();
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(std::vector<cv::Point3d>(sheet.begin(), sheet.end()), pose.turn, pose.shift,
                      cv::Matx33d(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1),
                      camera.distortion, pixels);
    cv::Matx33d rotation;
    cv::Rodrigues(pose.turn, rotation);
    constexpr int window = 14;
    BoardView view{.picture = {640, 480},
                   .planes = std::vector<std::vector<SeenCorner>>(planes),
                   .corners = pixels,
                   .focus = std::vector<double>(pixels.size()),
                   .powers = std::vector<double>(planes, NAN),
                   .codes = std::vector<int>(planes, -1),
                   .window = window};
    for (std::size_t k = 0; k < pixels.size(); k++) {
        const cv::Vec3d at = rotation * cv::Vec3d(sheet[k].x, sheet[k].y, 0.0) + pose.shift;
        view.focus[k] = lens.focus(1.0 / at[2], pixels[k]);
        for (unsigned z = 0; z < planes; z++) {
            const double disk = 2.0 * (z - view.focus[k]) / 4.0, width = std::sqrt(1.67 + disk * disk);
            view.planes[z].push_back(
                {lens.seen(pixels[k], z), 100.0 * (1.0 / width - 1.128 / (window + 0.5))});
        }
    }
    return view;
}

std::vector<BoardView> views_of(const std::vector<Pose> &poses, const Lens &lens = {})
{
    std::vector<BoardView> views;
    for (const Pose &pose : poses)
        views.push_back(view_of(pose, lens));
    return views;
}

std::string refusal_of(const std::vector<Pose> &poses, const Lens &lens = {})
{
    try {
        calibrate(board, views_of(poses, lens));
    } catch (const Refusal &refusal) {
        return refusal.what();
    }
    return "";
}

bool is_said(const std::vector<std::string> &lines, const std::string &text)
{
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string &line) { return line.find(text) != std::string::npos; });
}

class TemporaryFile {
public:
    TemporaryFile() : path(testing::TempDir() + "calibration" + std::to_string(getpid()) + ".yml") {}
    ~TemporaryFile() { unlink(path.c_str()); }

    const std::string path;
};

} // namespace

TEST(Calibrate, the_sheet_has_every_dark_square_at_its_size)
{
    const std::string svg = Board{5, 4, 30.0}.sheet();
    EXPECT_NE(svg.find("width=\"210mm\" height=\"180mm\""), std::string::npos) << svg;
    std::size_t squares = 0;
    for (std::size_t at = svg.find("width=\"30\""); at != std::string::npos;
         at = svg.find("width=\"30\"", at + 1))
        squares++;
    EXPECT_EQ(squares, 10u);
    EXPECT_FALSE(Board::parse("10x7"));
    EXPECT_FALSE(Board::parse("3x7x25"));
    EXPECT_FALSE(Board::parse("10x7x-1"));
    EXPECT_EQ(Board::parse("12x9x8.5")->square_mm, 8.5);
}

TEST(Calibrate, good_boards_give_back_camera_and_lens)
{
    const RigCalibration found = calibrate(board, views_of(good_poses()));
    EXPECT_NEAR(found.camera.fx, 800.0, 0.5);
    EXPECT_NEAR(found.camera.cx, 321.0, 0.5);
    EXPECT_NEAR(found.camera.distortion[0], -0.05, 0.002);
    EXPECT_NEAR(found.blur_step, 2.0, 0.06);
    EXPECT_NEAR(found.aperture_mm, 1e3 * 2.0 / (800.0 * 0.54), 0.15);
    for (unsigned z = 0; z < planes; z++) {
        EXPECT_NEAR(found.focus.vergences[z], 3.4 - 0.54 * z, 0.01) << z;
        EXPECT_NEAR(found.warps.planes[z].scale(), (1.0 + 0.006 * (z - 3.0)), 1e-5);
        EXPECT_NEAR(found.warps.planes[z].dx, 0.3 * (z - 3.0), 1e-3);
    }
    EXPECT_NEAR(found.focus.field[2], -0.27, 0.02);
}

TEST(Calibrate, boards_that_do_not_suffice_are_refused_with_what_to_do)
{
    std::vector<Pose> poses = good_poses();
    EXPECT_NE(refusal_of({poses.begin(), poses.begin() + 4}).find("at least 5"), std::string::npos);

    for (Pose &pose : poses)
        pose.shift = {pose.shift[0], pose.shift[1], 0.5};
    for (Pose &pose : poses)
        pose.turn *= 0.3;
    EXPECT_NE(refusal_of(poses).find("one distance"), std::string::npos);

    poses = good_poses();
    Lens backwards;
    backwards.near = 3.4 - 5 * 0.54;
    backwards.step = -0.54;
    EXPECT_NE(refusal_of(poses, backwards).find("plane 0 must be the nearest"), std::string::npos);
}

TEST(Calibrate, boards_without_tilt_leave_the_focal_length_open)
{
    std::vector<BoardView> views;
    cv::RNG random(7);
    for (Pose pose : good_poses()) {
        pose.turn = {0.01 * pose.turn[0], 0.01 * pose.turn[1], 0.0};
        views.push_back(view_of(pose));
        for (auto &plane : views.back().planes)
            for (SeenCorner &corner : plane)
                corner.at += cv::Point2d(random.gaussian(0.2), random.gaussian(0.2));
    }
    try {
        const RigCalibration found = calibrate(board, views);
        EXPECT_TRUE(is_said(found.weak, "tilted"))
            << "and nothing is said of it, within " << found.focal_deviation;
    } catch (const Refusal &refusal) {
        EXPECT_NE(std::string(refusal.what()).find("tilt the board"), std::string::npos) << refusal.what();
    }
}

TEST(Calibrate, a_board_that_moved_during_its_sweep_is_left_out)
{
    std::vector<BoardView> views = views_of(good_poses());
    for (unsigned z = 0; z < planes; z++)
        for (SeenCorner &corner : views[4].planes[z])
            corner.at += cv::Point2d(3.0, -1.0) * static_cast<double>(z);
    const RigCalibration found = calibrate(board, views);
    EXPECT_EQ(found.boards, 11u);
    EXPECT_TRUE(is_said(found.weak, "moved during its sweep"));
    EXPECT_NEAR(found.warps.planes[0].dx, -0.9, 0.01);
    EXPECT_NEAR(found.camera.fx, 800.0, 1.0);
}

TEST(Calibrate, planes_that_saw_no_board_are_named_with_their_distance)
{
    const std::vector<Pose> all = good_poses();
    const RigCalibration found = calibrate(board, views_of({all.begin(), all.begin() + 8}));
    EXPECT_TRUE(is_said(found.weak, "Plane 5"));
    EXPECT_FALSE(is_said(found.weak, "Plane 1"));
}

TEST(Calibrate, a_source_that_says_other_powers_is_told)
{
    std::vector<BoardView> views = views_of(good_poses());
    for (unsigned z = 0; z < planes; z++)
        views[0].powers[z] = 1.25 * (3.4 - 0.54 * z);
    EXPECT_TRUE(is_said(calibrate(board, views).weak, "measure the squares"));
}

TEST(Calibrate, a_file_is_read_back_by_all_who_take_it)
{
    const TemporaryFile file;
    const RigCalibration found = calibrate(board, views_of(good_poses()));
    write_calibration(file.path, found, board);
    EXPECT_EQ(read_camera_calibration(file.path).width, 640u);
    const auto focus = read_focus_calibration(file.path);
    ASSERT_TRUE(focus);
    EXPECT_EQ(focus->vergences.size(), planes);
    EXPECT_NEAR(focus->field[2], found.focus.field[2], 1e-9);
    const RigCalibration again = read_calibration(file.path);
    EXPECT_NEAR(again.camera.fx, found.camera.fx, 1e-9);
    EXPECT_NEAR(again.warps.planes[0].dx, found.warps.planes[0].dx, 1e-9);
    EXPECT_NEAR(again.warps.planes[5].scale(), found.warps.planes[5].scale(), 1e-9);
}

TEST(Calibrate, an_old_file_has_no_focus_and_bad_ones_say_why)
{
    const TemporaryFile file;
    std::ofstream(file.path) << "%YAML:1.0\n---\nimage_width: 128\n";
    EXPECT_FALSE(read_focus_calibration(file.path));
    std::ofstream(file.path)
        << "%YAML:1.0\n---\nfocus:\n   vergences: [ 1., 2. ]\n   field: [ 0., 0., 0. ]\n";
    try {
        read_focus_calibration(file.path);
        FAIL();
    } catch (const std::runtime_error &error) {
        EXPECT_NE(std::string(error.what()).find("must fall"), std::string::npos);
    }
}

TEST(Calibrate, a_check_tells_what_has_changed)
{
    const RigCalibration known = calibrate(board, views_of(good_poses()));
    std::vector<Pose> poses = good_poses();
    poses.resize(6);
    EXPECT_TRUE(check(known, board, views_of(poses)).faults.empty());

    Lens warm, breathing;
    warm.near += 0.2;
    EXPECT_TRUE(is_said(check(known, board, views_of(poses, warm)).faults, "other distances"));
    breathing.shift = 0.6;
    EXPECT_TRUE(is_said(check(known, board, views_of(poses, breathing)).faults, "breathes"));
}

TEST(LensPoints, a_profile_of_a_tape_is_one_that_lenses_take)
{
    const TemporaryFile file;
    const LensPoints points = LensPoints::parse("310=0.5,120=2.0,200=1.0");
    points.write(file.path, "my webcam");
    const FocusPoints profile = FocusPoints::load(file.path);
    EXPECT_EQ(profile.lens(), "my webcam");
    EXPECT_DOUBLE_EQ(profile.nearest(), 2.0);
    EXPECT_DOUBLE_EQ(profile.position(1.0), 200.0);
    EXPECT_DOUBLE_EQ(profile.position(0.5), 120.0);
    /* On the line from 120 at 0.5 to 310 at 2 dioptres, 200 is at 1.1316. */
    EXPECT_NEAR(*points.largest_miss(), 0.1316, 1e-4);
    EXPECT_NE(points.worth().find("0.132 dioptres: 526 mm at 2.00 m, 33 mm at 0.50 m."), std::string::npos)
        << points.worth();
}

namespace {

/* Six planes that a lens was told by codes, the nearest first. */
const std::vector<double> vergences{3.4, 2.86, 2.32, 1.78, 1.24, 0.7};

std::string refusal_of_profile(const std::vector<int> &codes, const std::optional<std::string> &like = {})
{
    try {
        write_lens_profile("/nowhere/lens.yml", "lens", vergences, codes, like);
    } catch (const std::exception &error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(LensProfileFile, a_lens_is_where_its_codes_were)
{
    const TemporaryFile file;
    write_lens_profile(file.path, "webcam", vergences, {250, 210, 170, 130, 90, 50}, {});
    const FocusPoints profile = FocusPoints::load(file.path);
    EXPECT_EQ(profile.lens(), "webcam");
    EXPECT_DOUBLE_EQ(profile.position(3.4), 250.0);
    EXPECT_DOUBLE_EQ(profile.position(0.7), 50.0);
    EXPECT_NEAR(profile.position(2.05), 150.0, 1e-9);
}

TEST(LensProfileFile, a_liquid_lens_takes_after_the_profile_that_it_was_swept_with)
{
    const TemporaryFile nominal;
    std::ofstream(nominal.path)
        << "%YAML:1.0\n---\nlens: \"nominal\"\nnominal: 1\npower_at_infinity: 0.\n"
           "lens_power: [ -5., 15. ]\nvolts: [ 39., 58. ]\nsettle_us: 12345\noverdrive: 0.25\n";
    const std::string file = nominal.path + ".found";
    write_lens_profile(file, "mine", vergences, {1023, 900, 700, 500, 300, 0}, nominal.path);
    const LensProfile profile = LensProfile::load(file);
    unlink(file.c_str());
    EXPECT_FALSE(profile.nominal());
    EXPECT_EQ(profile.settle().count(), 12345);
    EXPECT_DOUBLE_EQ(profile.overdrive(), 0.25);
    EXPECT_DOUBLE_EQ(profile.nearest(), 3.4);
    EXPECT_NEAR(profile.drive(0.7), 24.4, 1e-9); /* code 0 of a MAX14574, and code 1023 */
    EXPECT_NEAR(profile.drive(3.4), 69.9, 1e-9);
    EXPECT_NE(refusal_of_profile({1024, 900, 700, 500, 300, 0}, nominal.path).find("no code of the MAX14574"),
              std::string::npos);
    EXPECT_NE(refusal_of_profile({0, 300, 500, 700, 900, 1023}, nominal.path).find("do not rise"),
              std::string::npos);
}

TEST(LensProfileFile, codes_that_make_no_profile_are_refused)
{
    EXPECT_NE(refusal_of_profile({}).find("do not say what the lens was told"), std::string::npos);
    EXPECT_NE(refusal_of_profile({5, 5, 4, 3, 2, 1}).find("told the same"), std::string::npos);
}

TEST(LensProfileFile, codes_are_those_that_all_sweeps_say)
{
    std::vector<BoardView> views = views_of(good_poses());
    EXPECT_TRUE(calibrate(board, views).codes.empty());
    for (BoardView &view : views)
        view.codes = {250, 210, 170, 130, 90, 50};
    EXPECT_EQ(calibrate(board, views).codes, views.front().codes);
    views.back().codes[2] = 171;
    EXPECT_TRUE(calibrate(board, views).codes.empty());
}

TEST(Coverage, what_boards_have_not_shown_is_named)
{
    const std::vector<Pose> all = good_poses();
    const std::string missing = still_missing(views_of({all.begin(), all.begin() + 4}));
    EXPECT_NE(missing.find("sharp in plane 3, 4, 5"), std::string::npos) << missing;
    BoardView everywhere = view_of(all.front());
    for (cv::Point2d &corner : everywhere.corners)
        corner = {20.0, 470.0};
    const std::string parts = still_missing({everywhere});
    EXPECT_NE(
        parts.find("in the picture's upper left, top, upper right, left, middle, right, bottom, lower right"),
        std::string::npos)
        << parts;
    for (std::size_t k = 0; k < everywhere.corners.size(); k++) {
        everywhere.corners[k] = {static_cast<double>(k % 9) * 79.0, static_cast<double>(k / 9) * 95.0};
        everywhere.focus[k] = static_cast<double>(k % planes);
    }
    EXPECT_EQ(still_missing({everywhere}), "");
}

TEST(LensPoints, two_points_do_not_know_their_error)
{
    const LensPoints points = LensPoints::parse("5=1,2=0.25");
    EXPECT_FALSE(points.largest_miss());
    EXPECT_NE(points.worth().find("third"), std::string::npos);
}

TEST(LensPoints, what_is_no_points_is_refused_with_what_to_do)
{
    for (const char *text :
         {"", "1=2", "1=2,3", "1=2,x=3", "1=2,3=0", "1=2,3=-1", "1=2,3=2", "1=2,3=1,2=0.5", "1=2,,3=1",
          "1=2,1=1", "1=2,3=1e-9", "1=2,1e12=1", "1=inf,2=1", "nan=1,2=2", "1:2,3:1", "-1=-2,3=1"})
        EXPECT_THROW(LensPoints::parse(text), std::invalid_argument) << text;
}
