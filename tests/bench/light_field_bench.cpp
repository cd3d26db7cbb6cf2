/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* light-field-bench [ROUNDS [LAYOUT]]: what a picture of 1920x1080 and its depth map cost as each layout,
 * beside a memory copy of what comes out. Everything runs in turn in one process; processor times hold on a
 * machine that is not quiet. */
#include "engine/light_field_renderer.h"
#include "engine/scene/scene_files.h"
#include "engine/scene/scene_shapes.h"
#include "optics/depth_scale.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <sys/resource.h>

using namespace dff;

namespace {

constexpr PictureSize picture_size{1920, 1080};

double cpu_ms()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-3 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

double wall_ms()
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

struct Times {
    std::vector<double> cpu, wall;

    void add(const std::function<void()> &work)
    {
        const double cpu_start = cpu_ms(), wall_start = wall_ms();
        work();
        cpu.push_back(cpu_ms() - cpu_start);
        wall.push_back(wall_ms() - wall_start);
    }
};

struct Case {
    const char *name;
    LightFieldParameters parameters;
    PictureSize output;
};

std::vector<Case> cases()
{
    LightFieldParameters quilt;
    quilt.view_aspect = 0.75;
    LightFieldParameters stereo = quilt;
    stereo.layout = LightFieldLayout::Views;
    stereo.columns = 2;
    stereo.rows = 1;
    stereo.view_aspect = 0.0;
    LightFieldParameters lenticular = quilt;
    lenticular.layout = LightFieldLayout::Lenticular;
    lenticular.sheet = {246.0, -0.19, 0.25, true, false, false, false};
    LightFieldParameters elemental = quilt;
    elemental.layout = LightFieldLayout::Elemental;
    elemental.lenses.pitch = 15.5;
    LightFieldParameters rgbd = quilt;
    rgbd.layout = LightFieldLayout::Rgbd;
    return {{"quilt 8x6, 3360x3360", quilt, {3360, 3360}},
            {"stereo, 3840x1080", stereo, {3840, 1080}},
            {"lenticular, 1536x2048", lenticular, {1536, 2048}},
            {"elemental, 1920x1080", elemental, {1920, 1080}},
            {"rgbd, 3840x1080", rgbd, {3840, 1080}}};
}

void measure(const Case &c, const cv::Mat &color, const cv::Mat1w &depth, int rounds)
{
    const size_t stride = size_t{4} * c.output.width;
    std::vector<std::byte> output(stride * c.output.height), copy(output.size());
    LightFieldRenderer renderer(Device::open(""), {PixelFormat::Rgbx, picture_size, c.output}, c.parameters);
    const auto bytes = [](const cv::Mat &m) {
        return std::as_bytes(std::span(m.data, m.total() * m.elemSize()));
    };
    const auto render = [&] {
        renderer.render({bytes(color), color.step}, {bytes(depth), depth.step}, output, stride);
    };
    render(); /* compiles */
    Times rendering, copying;
    for (int round = 0; round < rounds; round++) {
        rendering.add(render);
        copying.add([&] { std::memcpy(copy.data(), output.data(), copy.size()); });
    }
    std::printf("| %s | %.1f | %.1f | %.1f | %.1f |", c.name, median(rendering.cpu), median(rendering.wall),
                1e3 / median(rendering.wall), median(rendering.cpu) / median(copying.cpu));
    for (const auto &[stage, ms] : renderer.times())
        std::printf(" %s %.1f", stage.c_str(), ms);
    std::printf(" |\n");
    std::fflush(stdout);
}

} // namespace

int main(int count, char **arguments)
{
    const int rounds = count > 1 ? std::max(1, std::atoi(arguments[1])) : 9;
    const Scene scene = resize_scene(make_shapes({480, 270}, 1), {picture_size.width, picture_size.height});
    cv::Mat color;
    cv::cvtColor(scene.color, color, cv::COLOR_RGB2RGBA);
    cv::Mat1w depth;
    scene.depth.convertTo(depth, CV_16U, DepthScale::max_pixel - 1, 1.0);
    std::printf(
        "| layout | processor ms | ms | frames/s | of a copy | stages, ms |\n|---|---|---|---|---|---|\n");
    for (const Case &c : cases())
        if (count <= 2 || std::string_view(c.name).starts_with(arguments[2]))
            measure(c, color, depth, rounds);
}
