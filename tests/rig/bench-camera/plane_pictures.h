/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/swept_camera.h"

#include <arv.h>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace dff {

/* What the client has set that changes how a picture looks. */
struct PictureFormat {
    ArvPixelFormat pixels = ARV_PIXEL_FORMAT_MONO_8;
    cv::Rect region;
    double brightness = 1.0; /* of exposure and gain, 1: as the scene was rendered */

    bool operator==(const PictureFormat &) const = default;
};

/* The simulated camera's pictures in the pixels of a GenICam camera. All planes are rendered at the start and
 * replayed; what a client changes takes one conversion a plane. */
class PlanePictures {
public:
    /* Different noise is shown in this many sweeps, which then repeat. */
    static constexpr unsigned noise_realisations = 4;

    explicit PlanePictures(const SweptCamera &camera);

    cv::Size size() const { return size_; }

    /* Mono8, Mono10, Mono12, Mono16, BayerRG8 or RGB8, little endian, rows without padding. */
    void set_format(const PictureFormat &format);

    /* Copies one picture, as much of it as there is room for. */
    void copy(uint64_t sweep, unsigned plane, std::span<uint8_t> out);

    /* Writes frame_stamp() over the first pixels of such a picture. */
    void stamp(uint64_t value, std::span<uint8_t> out) const;

private:
    const cv::Mat &converted(size_t index);

    cv::Size size_;
    unsigned planes_;
    unsigned realisations_;
    std::vector<cv::Mat3b> rendered_; /* plane after plane of one realisation of the noise after the other */
    PictureFormat format_;
    std::vector<cv::Mat> converted_; /* empty until needed */
};

} // namespace dff
