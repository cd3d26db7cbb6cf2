/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "board_collector.h"
#include "calibration_file.h"
#include "calibration_plots.h"
#include "lens_points.h"
#include "lens_profile_file.h"
#include "options.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>

namespace {

constexpr int refused = 1;
constexpr int misused = 2;

void write_sheet(const dff::Options &options)
{
    std::ofstream file(options.sheet, std::ios::binary);
    file << options.board.sheet();
    file.close();
    if (!file)
        throw std::runtime_error("The sheet " + options.sheet + " cannot be written");
    std::cout << "Print " << options.sheet
              << " at its own size (100 %), measure a row of squares, and mount it flat.\n";
}

void write_points(const dff::Options &options)
{
    const dff::LensPoints points = dff::LensPoints::parse(options.points);
    points.write(options.output, options.lens);
    std::cout << options.output << " is for lens-profile, from " << points.points().front().metres << " to "
              << points.points().back().metres << " m. " << points.worth() << '\n';
}

dff::BoardCollector look_for_boards(const dff::Options &options)
{
    dff::BoardCollector collector(options.board,
                                  [](const std::string &line) { std::cout << line << std::endl; });
    for (const std::string &source : options.sources) {
        dff::SweepReader reader(source);
        while (collector.views().size() < options.boards) {
            const auto sweep = reader.next();
            if (!sweep)
                break;
            collector.add(*sweep);
        }
        collector.end_source();
    }
    if (collector.views().empty())
        throw dff::Refusal("No board was measured, for the reasons above");
    return collector;
}

void report_light(const dff::RigCalibration &found)
{
    for (std::size_t z = 0; z < found.light.planes.size(); z++)
        std::printf("light %-2zu         %.4f times as bright; corners lose %.1f %%, within %.1f %%\n", z,
                    found.light.planes[z].gain, 100 * found.light.planes[z].vignetting,
                    100 * found.light.planes[z].deviation);
    if (!found.light.planes.empty())
        std::printf("left over        %.2f %% of light\n", 100 * found.light.residual);
    if (found.noise.is_known)
        std::printf("noise            variance %.3f I + %.2f of 8-bit values; %.1f at mid-gray\n",
                    found.noise.slope, found.noise.offset,
                    std::sqrt(128 * found.noise.slope + found.noise.offset));
    if (!found.bad_pixels.empty())
        std::printf("bad pixels       %zu, first at column %d, row %d\n", found.bad_pixels.size(),
                    found.bad_pixels.front().x, found.bad_pixels.front().y);
}

void report(const dff::RigCalibration &found)
{
    const dff::CameraCalibration &camera = found.camera;
    std::printf("%zu boards\n", found.boards);
    std::printf("focal length     %.1f x %.1f px, within %.2f %%; centre %.1f, %.1f\n", camera.fx, camera.fy,
                100 * found.focal_deviation, camera.cx, camera.cy);
    std::printf("distortion       k1 %.4f  k2 %.4f  p1 %.5f  p2 %.5f\n", camera.distortion[0],
                camera.distortion[1], camera.distortion[2], camera.distortion[3]);
    std::printf(
        "left over        %.3f px of corners, %.3f px of them in single planes, %.3f planes of focus\n",
        found.reprojection_px, found.warps.residual_px, found.focus.residual / found.focus.step());
    for (std::size_t z = 0; z < found.focus.vergences.size(); z++)
        std::printf("plane %-2zu         %.4f +- %.4f dioptres; %.3f, %.3f px, %.4f times as large\n", z,
                    found.focus.vergences[z], found.focus.deviations[z], found.warps.planes[z].dx,
                    found.warps.planes[z].dy, found.warps.planes[z].scale());
    std::printf("field            %.3f planes to the corner, within %.3f\n",
                -found.focus.field[2] / found.focus.step(), found.focus.field_deviation / found.focus.step());
    std::printf("blur             %.2f px a plane: an aperture of %.2f mm\n", found.blur_step,
                found.aperture_mm);
    report_light(found);
    for (const std::string &weakness : found.weak)
        std::printf("weak: %s\n", weakness.c_str());
}

int run_check(const dff::Options &options)
{
    const dff::RigCalibration known = dff::read_calibration(options.check);
    const dff::CalibrationCheck found = dff::check(known, options.board, look_for_boards(options).views());
    std::printf("corners are off by %.3f px, planes by up to %.3f px, focus by %.3f planes\n",
                found.reprojection_px, found.shift_px, found.vergence_planes);
    for (const std::string &fault : found.faults)
        std::printf("%s\n", fault.c_str());
    std::printf("%s\n", found.faults.empty() ? "The calibration fits."
                                             : "The calibration does not fit any more: make a new one.");
    return found.faults.empty() ? 0 : refused;
}

int run(const dff::Options &options)
{
    if (!options.sheet.empty())
        write_sheet(options);
    if (!options.points.empty())
        write_points(options);
    if (options.sources.empty())
        return 0;
    if (!options.check.empty())
        return run_check(options);
    const dff::BoardCollector seen = look_for_boards(options);
    dff::RigCalibration found = dff::calibrate(options.board, seen.views());
    found.bad_pixels = seen.bad_pixels();
    report(found);
    dff::write_calibration(options.output, found, options.board);
    std::printf("%s is for every calibration property.\n", options.output.c_str());
    if (!options.profile.empty()) {
        dff::write_lens_profile(options.profile, options.lens, found.focus.vergences, found.codes,
                                options.like);
        std::printf("%s is for lens-profile.\n", options.profile.c_str());
    }
    if (!options.plots.empty())
        dff::write_plots(options.plots, found);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    try {
        return run(dff::parse_options(argc, argv));
    } catch (const std::invalid_argument &error) {
        std::cerr << error.what() << '\n';
        return misused;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return refused;
    }
}
