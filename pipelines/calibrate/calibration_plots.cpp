/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "calibration_plots.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace dff {

namespace {

/* Of a diagram, with the margins of its frame; pixels. */
constexpr double width = 360.0, height = 240.0, margin = 48.0, top = 36.0, right = 12.0;

/* A diagram with axes from `least` to `most`. */
class Diagram {
public:
    Diagram(cv::Point2d corner, const std::string &title, cv::Point2d least, cv::Point2d most)
        : least_(least), most_(most)
    {
        svg_ << std::fixed << std::setprecision(2) << "<g transform=\"translate(" << corner.x << ' '
             << corner.y << ")\">\n<rect x=\"" << margin << "\" y=\"" << top << "\" width=\""
             << width - margin - right << "\" height=\"" << height - top - margin
             << "\" fill=\"none\" stroke=\"#888\"/>\n"
             << text({width / 2, 14}, "middle", title);
        constexpr double ticks = 4.0;
        for (int i = 0; i <= ticks; i++) {
            const cv::Point2d at(std::lerp(least.x, most.x, i / ticks),
                                 std::lerp(least.y, most.y, i / ticks));
            svg_ << text({place(at).x, height - margin + 16}, "middle", number(at.x))
                 << text({margin - 4, place(at).y + 4}, "end", number(at.y));
        }
    }

    void dot(cv::Point2d at, const std::string &colour)
    {
        const cv::Point2d p = place(at);
        svg_ << "<circle cx=\"" << p.x << "\" cy=\"" << p.y << "\" r=\"1.5\" fill=\"" << colour << "\"/>\n";
    }

    void line(const std::vector<cv::Point2d> &points, const std::string &colour)
    {
        svg_ << "<polyline fill=\"none\" stroke=\"" << colour << "\" points=\"";
        for (const cv::Point2d &point : points)
            svg_ << place(point).x << ',' << place(point).y << ' ';
        svg_ << "\"/>\n";
    }

    void name_axes(const std::string &x, const std::string &y)
    {
        svg_ << text({width / 2, height - margin + 32}, "middle", x) << text({margin, top - 6}, "start", y);
    }

    std::string finish() const { return svg_.str() + "</g>\n"; }

private:
    static std::string number(double value)
    {
        std::ostringstream digits;
        digits << std::setprecision(4) << value;
        return digits.str();
    }
    static std::string text(cv::Point2d at, const std::string &anchor, const std::string &words)
    {
        std::ostringstream tag;
        tag << "<text x=\"" << at.x << "\" y=\"" << at.y << "\" text-anchor=\"" << anchor << "\">" << words
            << "</text>\n";
        return tag.str();
    }
    cv::Point2d place(cv::Point2d at) const
    {
        const double x = (at.x - least_.x) / (most_.x - least_.x),
                     y = (at.y - least_.y) / (most_.y - least_.y);
        return {margin + x * (width - margin - right), height - margin - y * (height - top - margin)};
    }

    cv::Point2d least_, most_;
    std::ostringstream svg_;
};

/* Planes that a point lies farther away than the surface of focus. */
double miss_of(const FocusPoint &point, const FocusSurface &focus)
{
    return (focus.vergence_at(point.plane, point.at) - point.vergence) / focus.step();
}

std::string colour_of(double miss)
{
    constexpr double most = 0.3; /* planes */
    const int strength = static_cast<int>(255 * std::clamp(std::abs(miss) / most, 0.0, 1.0));
    std::ostringstream colour;
    colour << "rgb(" << (miss > 0 ? strength : 0) << ",0," << (miss > 0 ? 0 : strength) << ")";
    return colour.str();
}

std::string draw_places(const RigCalibration &found, cv::Point2d corner)
{
    const double w = found.camera.width, h = found.camera.height;
    const cv::Point2d center((w - 1) / 2, (h - 1) / 2);
    Diagram diagram(corner, "Corners; red: farther than the surface of focus, blue: nearer", {0, h}, {w, 0});
    for (const FocusPoint &point : found.points)
        diagram.dot(center + point.at * cv::norm(center), colour_of(miss_of(point, found.focus)));
    diagram.name_axes("pixels", "pixels");
    return diagram.finish();
}

std::string draw_vergences(const RigCalibration &found, cv::Point2d corner)
{
    const auto &vergences = found.focus.vergences;
    const double last = static_cast<double>(vergences.size()) - 1;
    Diagram diagram(corner, "Vergence of the planes, and corners less their field",
                    {-0.5, vergences.back() - found.focus.step()},
                    {last + 0.5, vergences.front() + found.focus.step()});
    std::vector<cv::Point2d> line;
    for (std::size_t z = 0; z < vergences.size(); z++)
        line.emplace_back(static_cast<double>(z), vergences[z]);
    for (const FocusPoint &point : found.points)
        diagram.dot({point.plane, point.vergence - found.focus.field_at(point.at)}, "#48a");
    diagram.line(line, "black");
    diagram.name_axes("plane", "dioptres");
    return diagram.finish();
}

std::string draw_misses(const RigCalibration &found, cv::Point2d corner)
{
    const double last = static_cast<double>(found.focus.vergences.size()) - 1;
    constexpr double most = 0.5;
    Diagram diagram(corner, "What is left of focus", {-0.5, -most}, {last + 0.5, most});
    for (const FocusPoint &point : found.points)
        diagram.dot({point.plane, std::clamp(miss_of(point, found.focus), -most, most)}, "#48a");
    diagram.line({{-0.5, 0.0}, {last + 0.5, 0.0}}, "black");
    diagram.name_axes("plane in which a corner is sharp", "planes");
    return diagram.finish();
}

std::string draw_light(const RigCalibration &found, cv::Point2d corner)
{
    const auto &planes = found.light.planes;
    constexpr int parts = 20;
    double least = 1.0, most = 1.0;
    for (const PlaneLight &plane : planes)
        for (const double light : {plane.gain, plane.gain * (1.0 - plane.vignetting)}) {
            least = std::min(least, light);
            most = std::max(most, light);
        }
    Diagram diagram(corner, "Light; planes from red, the nearest, to blue", {0.0, least - 0.05},
                    {1.0, most + 0.05});
    for (std::size_t z = 0; z < planes.size(); z++) {
        std::vector<cv::Point2d> line;
        for (int i = 0; i <= parts; i++) {
            const double radius = static_cast<double>(i) / parts;
            line.emplace_back(radius, planes[z].gain * (1.0 - planes[z].vignetting * radius * radius));
        }
        diagram.line(line, "hsl(" + std::to_string(240 * z / planes.size()) + ",80%,40%)");
    }
    diagram.name_axes("half diagonals from the centre", "times the middle plane");
    return diagram.finish();
}

std::string draw_noise(const RigCalibration &found, cv::Point2d corner)
{
    const RigNoise &noise = found.noise;
    constexpr double white = 255.0;
    Diagram diagram(corner, "Noise", {0.0, 0.0},
                    {white, 1.1 * std::sqrt(noise.slope * white + noise.offset)});
    std::vector<cv::Point2d> line;
    for (double value = 0.0; value <= white; value += 5.0)
        line.emplace_back(value, std::sqrt(noise.slope * value + noise.offset));
    diagram.line(line, "black");
    diagram.name_axes("brightness, DN", "standard deviation, DN");
    return diagram.finish();
}

} // namespace

void write_plots(const std::string &path, const RigCalibration &found)
{
    std::ofstream file(path, std::ios::binary);
    file << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << 2 * width << "\" height=\"" << 3 * height
         << "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" "
            "fill=\"white\"/>\n"
         << draw_places(found, {0, 0}) << draw_vergences(found, {width, 0})
         << draw_misses(found, {0, height});
    if (!found.light.planes.empty())
        file << draw_light(found, {width, height});
    if (found.noise.is_known)
        file << draw_noise(found, {0, 2 * height});
    file << "</svg>\n";
    file.close();
    if (!file)
        throw std::runtime_error("The plots " + path + " cannot be written");
}

} // namespace dff
