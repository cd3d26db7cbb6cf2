/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/point_cloud.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <opencv2/calib3d.hpp>
#include <string>

namespace dff {

namespace {

/* As in the file. */
struct Vertex {
    float x, y, z;
    uint8_t red, green, blue;
};
constexpr size_t vertex_bytes = 15;
static_assert(std::endian::native == std::endian::little, "vertices are written as they lie in memory");

std::string header(const char *unit, size_t vertices, bool uncertainty)
{
    return std::string("ply\nformat binary_little_endian 1.0\ncomment ") + unit +
           "; x right, y down, z away from the camera\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\n" +
           (uncertainty ? "property float uncertainty\n" : "") + "end_header\n";
}

} // namespace

PointCloud::PointCloud(const CameraCalibration &camera, unsigned stride)
    : stride_(stride), columns_((camera.width + stride - 1) / stride)
{
    std::vector<cv::Point2d> pixels;
    for (unsigned y = 0; y < camera.height; y += stride)
        for (unsigned x = 0; x < camera.width; x += stride)
            pixels.emplace_back(x, y);
    const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    std::vector<cv::Point2d> undistorted;
    cv::undistortPoints(pixels, undistorted, matrix, camera.distortion);
    rays_.reserve(undistorted.size());
    for (const cv::Point2d &point : undistorted)
        rays_.push_back({static_cast<float>(point.x), static_cast<float>(point.y)});
}

PointCloud PointCloud::orthographic(unsigned width, unsigned height, double pixel_size_um, unsigned stride)
{
    PointCloud cloud(width, stride);
    for (unsigned y = 0; y < height; y += stride)
        for (unsigned x = 0; x < width; x += stride)
            cloud.rays_.push_back({static_cast<float>((x - (width - 1) / 2.0) * pixel_size_um),
                                   static_cast<float>((y - (height - 1) / 2.0) * pixel_size_um)});
    return cloud;
}

bool PointCloud::shows(float distance, double max_distance) const
{
    return std::isfinite(distance) && distance <= max_distance && (orthographic_ || distance > 0.0f);
}

PointCloud::Point PointCloud::point(const Ray &ray, float distance) const
{
    if (orthographic_)
        return {ray.x, ray.y, distance * 1e6f};
    return {ray.x * distance, ray.y * distance, distance};
}

float PointCloud::deviation(const DepthUncertainty &uncertainty, uint16_t depth, unsigned x, unsigned y) const
{
    const uint16_t pixels = uncertainty.deviations.depth(x, y);
    const float metres = pixels > 0 ? uncertainty.slopes[depth] * pixels : NAN;
    return orthographic_ ? metres * 1e6f : metres;
}

std::vector<uint8_t> PointCloud::write(const PictureView &colour, const PictureView &depth,
                                       std::span<const float> distances, double max_distance,
                                       const DepthUncertainty *uncertainty) const
{
    std::vector<Vertex> vertices;
    std::vector<float> deviations; /* as many, or none */
    vertices.reserve(rays_.size());
    for (unsigned y = 0; y < depth.height; y += stride_)
        for (unsigned x = 0; x < depth.width; x += stride_) {
            const float z = distances[depth.depth(x, y)];
            if (!shows(z, max_distance))
                continue;
            const Point at = point(rays_[size_t{y / stride_} * columns_ + x / stride_], z);
            const uint8_t *rgb = colour.row(y) + size_t{3} * x;
            vertices.push_back({at.x, at.y, at.z, rgb[0], rgb[1], rgb[2]});
            if (uncertainty)
                deviations.push_back(deviation(*uncertainty, depth.depth(x, y), x, y));
        }

    const std::string head =
        header(orthographic_ ? "micrometres" : "metres", vertices.size(), uncertainty != nullptr);
    const size_t deviation_bytes = uncertainty ? sizeof(float) : 0;
    std::vector<uint8_t> file(head.size() + vertices.size() * (vertex_bytes + deviation_bytes));
    std::memcpy(file.data(), head.data(), head.size());
    uint8_t *out = file.data() + head.size();
    for (size_t k = 0; k < vertices.size(); k++) {
        std::memcpy(out, &vertices[k], vertex_bytes);
        out += vertex_bytes;
        if (uncertainty)
            std::memcpy(out, &deviations[k], deviation_bytes);
        out += deviation_bytes;
    }
    return file;
}

} // namespace dff
