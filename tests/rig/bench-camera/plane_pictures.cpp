/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "plane_pictures.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace dff {

namespace {

cv::Mat3b brightened(const cv::Mat3b &picture, double brightness)
{
    if (brightness == 1.0)
        return picture.clone();
    cv::Mat3b result;
    picture.convertTo(result, CV_8U, brightness);
    return result;
}

cv::Mat gray(const cv::Mat3b &picture, double full_scale)
{
    cv::Mat result;
    cv::cvtColor(picture, result, cv::COLOR_RGB2GRAY);
    if (full_scale > 255.0)
        result.convertTo(result, CV_16U, full_scale / 255.0);
    return result;
}

/* Rows of red and green alternate with rows of green and blue. */
cv::Mat bayer_rg(const cv::Mat3b &picture)
{
    cv::Mat1b result(picture.size());
    for (int y = 0; y < picture.rows; y++)
        for (int x = 0; x < picture.cols; x++)
            result(y, x) = picture(y, x)[x % 2 + y % 2];
    return result;
}

cv::Mat pixels_of(const cv::Mat3b &picture, ArvPixelFormat format)
{
    switch (format) {
    case ARV_PIXEL_FORMAT_MONO_10:
        return gray(picture, 1023.0);
    case ARV_PIXEL_FORMAT_MONO_12:
        return gray(picture, 4095.0);
    case ARV_PIXEL_FORMAT_MONO_16:
        return gray(picture, 65535.0);
    case ARV_PIXEL_FORMAT_BAYER_RG_8:
        return bayer_rg(picture);
    case ARV_PIXEL_FORMAT_RGB_8_PACKED:
        return picture;
    default:
        return gray(picture, 255.0);
    }
}

uint16_t white(ArvPixelFormat format)
{
    switch (format) {
    case ARV_PIXEL_FORMAT_MONO_10:
        return 1023;
    case ARV_PIXEL_FORMAT_MONO_12:
        return 4095;
    default:
        return 65535;
    }
}

} // namespace

PlanePictures::PlanePictures(const SweptCamera &camera)
    : size_(camera.size()), planes_(camera.plan().planes()),
      realisations_(camera.noisy() ? noise_realisations : 1)
{
    rendered_.resize(static_cast<size_t>(planes_) * realisations_);
    for (unsigned plane = 0; plane < planes_; plane++) {
        const cv::Mat3f exposed = camera.expose(plane);
        for (unsigned k = 0; k < realisations_; k++)
            rendered_[k * planes_ + plane] = camera.digitise(exposed, plane, k);
    }
    set_format({ARV_PIXEL_FORMAT_MONO_8, {{0, 0}, size_}, 1.0});
}

void PlanePictures::set_format(const PictureFormat &format)
{
    PictureFormat possible = format;
    possible.region &= cv::Rect({0, 0}, size_);
    if (possible == format_)
        return;
    format_ = possible;
    converted_.assign(rendered_.size(), {});
}

const cv::Mat &PlanePictures::converted(size_t index)
{
    cv::Mat &picture = converted_[index];
    if (picture.empty())
        picture = pixels_of(brightened(rendered_[index](format_.region), format_.brightness), format_.pixels);
    return picture;
}

void PlanePictures::copy(uint64_t sweep, unsigned plane, std::span<uint8_t> out)
{
    const cv::Mat &picture = converted(sweep % realisations_ * planes_ + plane);
    std::memcpy(out.data(), picture.data, std::min(out.size(), picture.total() * picture.elemSize()));
}

void PlanePictures::stamp(uint64_t value, std::span<uint8_t> out) const
{
    const size_t pixel_size = ARV_PIXEL_FORMAT_BIT_PER_PIXEL(format_.pixels) / 8;
    const uint16_t one = white(format_.pixels);
    if (out.size() < 64 * pixel_size)
        return;
    for (size_t i = 0; i < 64; i++) {
        const uint16_t level = value >> (63 - i) & 1 ? one : 0;
        for (size_t byte = 0; byte < pixel_size; byte++)
            out[i * pixel_size + byte] = static_cast<uint8_t>(level >> (pixel_size == 2 ? 8 * byte : 0));
    }
}

} // namespace dff
