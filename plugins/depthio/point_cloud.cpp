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

std::string header(const char *unit, size_t vertices)
{
    return std::string("ply\nformat binary_little_endian 1.0\ncomment ") + unit +
           "; x right, y down, z away from the camera\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
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

std::vector<uint8_t> PointCloud::write(const PictureView &colour, const PictureView &depth,
                                       std::span<const float> distances, double max_distance) const
{
    std::vector<Vertex> vertices;
    vertices.reserve(rays_.size());
    for (unsigned y = 0; y < depth.height; y += stride_)
        for (unsigned x = 0; x < depth.width; x += stride_) {
            const float z = distances[depth.depth(x, y)];
            if (!shows(z, max_distance))
                continue;
            const Point at = point(rays_[size_t{y / stride_} * columns_ + x / stride_], z);
            const uint8_t *rgb = colour.row(y) + size_t{3} * x;
            vertices.push_back({at.x, at.y, at.z, rgb[0], rgb[1], rgb[2]});
        }

    const std::string head = header(orthographic_ ? "micrometres" : "metres", vertices.size());
    std::vector<uint8_t> file(head.size() + vertices.size() * vertex_bytes);
    std::memcpy(file.data(), head.data(), head.size());
    uint8_t *out = file.data() + head.size();
    for (const Vertex &vertex : vertices) {
        std::memcpy(out, &vertex, vertex_bytes);
        out += vertex_bytes;
    }
    return file;
}

} // namespace dff
