/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "rig_calibration.h"

#include "coverage.h"
#include "focus_curves.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <opencv2/calib3d.hpp>
#include <sstream>

namespace dff {

namespace {

constexpr std::size_t fewest_boards = 5;
constexpr char tilt_words[] =
    "The focal length cannot be told from these boards: tilt the board by 20 to 40 degrees, to all "
    "four sides, at several distances";

std::string number(double value, int digits)
{
    std::ostringstream text;
    text << std::fixed << std::setprecision(digits) << value;
    return text.str();
}

cv::Matx33d matrix_of(const CameraCalibration &camera)
{
    return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}

std::vector<std::vector<cv::Point2f>> single_precision(const std::vector<std::vector<cv::Point2d>> &points)
{
    std::vector<std::vector<cv::Point2f>> result;
    for (const auto &view : points)
        result.emplace_back(view.begin(), view.end());
    return result;
}

void require_enough(const std::vector<BoardView> &views)
{
    if (views.size() < fewest_boards)
        throw Refusal(
            "There are " + std::to_string(views.size()) +
            " boards in different poses; at least 5 are needed, and 12 are good: near and far, in all parts "
            "of the picture, tilted to all sides");
}

/* Finds the warps, and leaves out boards that moved during their sweep, the worst first. */
PlaneWarps find_warps_at_rest(std::vector<BoardView> &views, std::vector<std::string> &weak)
{
    constexpr double least_px = 0.4, times = 4.0;
    while (true) {
        PlaneWarps warps = find_warps(views);
        const std::vector<double> left = left_of_views(views, warps);
        std::vector<double> sorted = left;
        std::sort(sorted.begin(), sorted.end());
        const auto worst = std::max_element(left.begin(), left.end()) - left.begin();
        if (sorted.back() < std::max(least_px, times * sorted[sorted.size() / 2]))
            return warps;
        weak.push_back("A board moved during its sweep (by some " + number(sorted.back(), 1) +
                       " px) and was left out: keep it at rest.");
        views.erase(views.begin() + worst);
        require_enough(views);
    }
}

void require_alike(const std::vector<BoardView> &views, cv::Size picture, std::size_t planes)
{
    for (const BoardView &view : views)
        if (view.picture != picture || view.planes.size() != planes)
            throw Refusal("The pictures are " + std::to_string(view.picture.width) + "x" +
                          std::to_string(view.picture.height) + " with " +
                          std::to_string(view.planes.size()) + " planes, others " +
                          std::to_string(picture.width) + "x" + std::to_string(picture.height) + " with " +
                          std::to_string(planes) + ": all must be of one rig");
}

/* Before all else, since a camera cannot be found without it. */
void require_distances(const std::vector<BoardView> &views)
{
    constexpr double least = 0.3; /* of the sweep */
    double nearest = 1e9, farthest = -1e9;
    for (const BoardView &view : views)
        for (const double plane : view.focus)
            if (!std::isnan(plane)) {
                nearest = std::min(nearest, plane);
                farthest = std::max(farthest, plane);
            }
    const double last = static_cast<double>(views.front().planes.size()) - 1.0;
    if (farthest - nearest < std::max(1.0, least * last))
        throw Refusal("All boards lie at one distance: they are sharp in planes " + number(nearest, 1) +
                      " to " + number(farthest, 1) + " of 0 to " + number(last, 0) +
                      ". Show the board near, far and in between, so that each plane sees it sharp");
}

std::vector<cv::Matx34d> find_camera(const Board &board, RigCalibration &result)
{
    const std::vector<std::vector<cv::Point3f>> sheet(result.warps.corners.size(), board.corner_points());
    const cv::Size size(static_cast<int>(result.camera.width), static_cast<int>(result.camera.height));
    cv::Mat matrix, distortion, turns, shifts, deviations, pose_deviations, errors;
    result.reprojection_px =
        cv::calibrateCamera(sheet, single_precision(result.warps.corners), size, matrix, distortion, turns,
                            shifts, deviations, pose_deviations, errors, cv::CALIB_FIX_K3,
                            cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-9)) /
        std::sqrt(2.0);
    const cv::Mat1d k = matrix, coefficients = distortion.reshape(1, 1), deviation = deviations;
    result.camera.fx = k(0, 0);
    result.camera.fy = k(1, 1);
    result.camera.cx = k(0, 2);
    result.camera.cy = k(1, 2);
    std::copy_n(coefficients.begin(), result.camera.distortion.size(), result.camera.distortion.begin());
    result.focal_deviation = std::max(deviation(0) / k(0, 0), deviation(1) / k(1, 1));

    std::vector<cv::Matx34d> poses;
    for (int v = 0; v < turns.rows; v++) {
        cv::Matx33d rotation;
        cv::Rodrigues(turns.row(v).reshape(1, 3), rotation);
        const auto shift = shifts.at<cv::Vec3d>(v);
        cv::Matx34d pose;
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 3; column++)
                pose(row, column) = rotation(row, column);
            pose(row, 3) = shift[row];
        }
        poses.push_back(pose);
    }
    return poses;
}

cv::Point2d place_of(cv::Point2d pixel, const CameraCalibration &camera)
{
    const cv::Point2d center((camera.width - 1) / 2.0, (camera.height - 1) / 2.0);
    return (pixel - center) / cv::norm(center);
}

std::vector<FocusPoint> focus_points(const Board &board, const std::vector<BoardView> &views,
                                     const RigCalibration &calibration, const PlaneWarps &warps,
                                     const std::vector<cv::Matx34d> &poses)
{
    const std::vector<cv::Point3f> sheet = board.corner_points();
    std::vector<FocusPoint> points;
    for (std::size_t v = 0; v < views.size(); v++)
        for (std::size_t k = 0; k < sheet.size(); k++) {
            const cv::Vec3d at = poses[v] * cv::Vec4d(sheet[k].x, sheet[k].y, sheet[k].z, 1.0);
            if (!std::isnan(views[v].focus[k]) && at[2] > 0.0)
                points.push_back(
                    {views[v].focus[k], place_of(warps.corners[v][k], calibration.camera), 1.0 / at[2]});
        }
    return points;
}

/* A board that faces the camera is as large near to a short lens as far from a long one. */
void require_tilt(const std::vector<cv::Matx34d> &poses)
{
    constexpr double least_sine = 0.17; /* 10 degrees */
    constexpr std::ptrdiff_t fewest = 3;
    const auto tilted = std::count_if(poses.begin(), poses.end(), [](const cv::Matx34d &pose) {
        return std::hypot(pose(0, 2), pose(1, 2)) > least_sine;
    });
    if (tilted < fewest)
        throw Refusal(tilt_words);
}

void require_sense(const RigCalibration &result)
{
    constexpr double largest_deviation = 0.02, largest_error_px = 1.0, largest_residual = 0.5;
    if (result.reprojection_px > largest_error_px)
        throw Refusal(
            "The boards do not fit one camera (" + number(result.reprojection_px, 2) +
            " pixels are left): the sheet must be flat, and it and the camera at rest during a sweep");
    if (!(result.focal_deviation < largest_deviation))
        throw Refusal(tilt_words);
    const auto &vergences = result.focus.vergences;
    if (std::adjacent_find(vergences.begin(), vergences.end(), std::less_equal<>()) != vergences.end())
        throw Refusal(
            "Vergences do not fall from plane to plane: plane 0 must be the nearest, and each frame of the "
            "plane that it is said to be");
    if (result.focus.residual > largest_residual * result.focus.step())
        throw Refusal(
            "Sharpness does not follow distance (" + number(result.focus.residual / result.focus.step(), 2) +
            " planes are left): the board and the light must rest during a sweep, and each sweep be alike");
}

/* How many parts of the picture have a corner of a board. */
int parts_covered(const RigCalibration &result)
{
    const cv::Size picture(static_cast<int>(result.camera.width), static_cast<int>(result.camera.height));
    std::set<int> parts;
    for (const auto &view : result.warps.corners)
        parts.merge(parts_with(view, picture));
    return static_cast<int>(parts.size());
}

void find_weakness(RigCalibration &result, const std::vector<FocusPoint> &points)
{
    constexpr double unsure = 0.1; /* planes */
    const double step = result.focus.step();
    if (result.focal_deviation > 0.003)
        result.weak.push_back("The focal length is known within " + number(100 * result.focal_deviation, 2) +
                              " %: more boards that are tilted would help.");
    if (const int parts = parts_covered(result); parts < parts_of_picture)
        result.weak.push_back(
            std::to_string(parts_of_picture - parts) +
            " of nine parts of the picture saw no board; distortion and field are guessed there: "
            "show it in the corners.");
    if (result.focus.field_deviation > unsure * step)
        result.weak.push_back("The field's curvature is known within " +
                              number(result.focus.field_deviation / step, 2) +
                              " planes: show the board in the corners at several distances.");
    for (std::size_t z = 0; z < result.focus.vergences.size(); z++) {
        const bool seen = std::any_of(points.begin(), points.end(),
                                      [z](const FocusPoint &point) { return is_sharp_in(point.plane, z); });
        if (!seen || result.focus.deviations[z] > unsure * step)
            result.weak.push_back(
                "Plane " + std::to_string(z) + (seen ? " is weakly determined" : " saw no board sharp") +
                ": show the board at " + number(1.0 / result.focus.vergences[z], 2) + " m.");
    }
}

/* What the source says of its planes tells of a wrong square, since all distances scale with it. */
void compare_powers(const std::vector<BoardView> &views, RigCalibration &result)
{
    const std::vector<double> &said = views.front().powers;
    if (std::any_of(said.begin(), said.end(), [](double power) { return std::isnan(power); }))
        return;
    double largest = 0.0;
    for (std::size_t z = 0; z < said.size(); z++)
        largest = std::max(largest, std::abs(said[z] - result.focus.vergences[z]));
    if (largest > 0.5 * result.focus.step())
        result.weak.push_back("The source says " + number(said.front(), 2) + " to " + number(said.back(), 2) +
                              " dioptres, the boards " + number(result.focus.vergences.front(), 2) + " to " +
                              number(result.focus.vergences.back(), 2) +
                              ": measure the squares (--board) once more before you trust the boards.");
}

/* What the lens was told, if all views say the same. */
std::vector<int> codes_of(const std::vector<BoardView> &views)
{
    const std::vector<int> &codes = views.front().codes;
    const bool is_known = std::all_of(codes.begin(), codes.end(), [](int code) { return code >= 0; });
    const bool is_one =
        std::all_of(views.begin(), views.end(), [&](const BoardView &view) { return view.codes == codes; });
    return is_known && is_one ? codes : std::vector<int>();
}

void find_light(const Board &board, const std::vector<BoardView> &views, RigCalibration &result)
{
    std::vector<BoardSquares> squares;
    for (const BoardView &view : views)
        squares.push_back({view.squares, view.focus});
    result.light =
        fit_light(board, squares, views.front().picture, views.front().planes.size(), result.blur_step);
    result.noise = fit_noise(squares, result.blur_step);
    constexpr double unsure = 0.02;
    if (result.light.is_clipped)
        result.weak.push_back(
            "White squares are as bright as a picture can be: expose less, or gain and vignetting "
            "cannot be told.");
    else if (result.light.planes.empty())
        result.weak.push_back(
            "Gain and vignetting of the planes are not known: each plane must see white squares that are "
            "20 pixels and more and nearly sharp.");
    double deviation = 0.0;
    for (const PlaneLight &plane : result.light.planes)
        deviation = std::max(deviation, plane.deviation);
    if (deviation > unsure)
        result.weak.push_back("Vignetting is known within " + number(100 * deviation, 0) +
                              " % in some planes: show the board in the corners, evenly lit.");
}

std::vector<cv::Matx34d> poses_by(const RigCalibration &calibration, const Board &board,
                                  const PlaneWarps &warps, double &error_px)
{
    std::vector<cv::Matx34d> poses;
    double sum = 0.0;
    std::size_t count = 0;
    const std::vector<cv::Point3f> points = board.corner_points();
    const std::vector<cv::Point3d> sheet(points.begin(), points.end());
    for (const auto &corners : warps.corners) {
        cv::Vec3d turn, shift;
        std::vector<cv::Point2d> seen;
        cv::Matx33d rotation;
        cv::solvePnP(sheet, corners, matrix_of(calibration.camera), calibration.camera.distortion, turn,
                     shift);
        cv::projectPoints(sheet, turn, shift, matrix_of(calibration.camera), calibration.camera.distortion,
                          seen);
        for (std::size_t k = 0; k < seen.size(); k++)
            sum += (seen[k] - corners[k]).ddot(seen[k] - corners[k]) / 2.0;
        count += seen.size();
        cv::Rodrigues(turn, rotation);
        cv::Matx34d pose;
        cv::hconcat(rotation, shift, pose);
        poses.push_back(pose);
    }
    error_px = std::sqrt(sum / static_cast<double>(count));
    return poses;
}

} // namespace

RigCalibration calibrate(const Board &board, std::vector<BoardView> views)
{
    require_enough(views);
    require_alike(views, views.front().picture, views.front().planes.size());
    RigCalibration result;
    result.blur_step = find_focus(views);
    require_distances(views);
    result.camera.width = static_cast<unsigned>(views.front().picture.width);
    result.camera.height = static_cast<unsigned>(views.front().picture.height);
    result.warps = find_warps_at_rest(views, result.weak);
    result.boards = views.size();
    const std::vector<cv::Matx34d> poses = find_camera(board, result);
    require_tilt(poses);
    const std::vector<FocusPoint> points = focus_points(board, views, result, result.warps, poses);
    result.focus = fit_surface(points, static_cast<unsigned>(views.front().planes.size()), views.size());
    result.points = points;
    require_sense(result);
    result.aperture_mm = 1e3 * result.blur_step / (result.camera.fx * result.focus.step());
    find_light(board, views, result);
    find_weakness(result, points);
    compare_powers(views, result);
    result.codes = codes_of(views);
    return result;
}

CalibrationCheck check(const RigCalibration &calibration, const Board &board, std::vector<BoardView> views)
{
    constexpr double most_px = 0.5, most_shift_px = 0.3, most_planes = 0.2;
    require_alike(views,
                  {static_cast<int>(calibration.camera.width), static_cast<int>(calibration.camera.height)},
                  calibration.warps.planes.size());
    CalibrationCheck found;
    find_focus(views);
    const PlaneWarps warps = apply_warps(views, calibration.warps.planes);
    const std::vector<cv::Matx34d> poses = poses_by(calibration, board, warps, found.reprojection_px);
    for (const cv::Point2d &offset : warps.offsets)
        found.shift_px = std::max(found.shift_px, cv::norm(offset));
    double sum = 0.0;
    const std::vector<FocusPoint> points = focus_points(board, views, calibration, warps, poses);
    for (const FocusPoint &point : points)
        sum += (calibration.focus.vergence_at(point.plane, point.at) - point.vergence) /
               calibration.focus.step();
    found.vergence_planes = points.empty() ? 0.0 : sum / static_cast<double>(points.size());

    if (found.reprojection_px > most_px)
        found.faults.push_back("The camera no longer projects as it did: the lens was moved or changed.");
    if (found.shift_px > most_shift_px)
        found.faults.push_back(
            "The planes no longer lie on each other: the lens breathes otherwise, or is tilted.");
    if (std::abs(found.vergence_planes) > most_planes)
        found.faults.push_back(
            "The planes are in focus at other distances: the lens' drive or temperature has changed.");
    return found;
}

} // namespace dff
