/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_shape.h"

#include <opencv2/core.hpp>

namespace dff {

/* The pictures of a stack as OpenCV sees them, without a copy: [z][component]. What is done to them is done
 * to `memory`, the bytes of `view`. */
using StackPictureViews = std::vector<std::vector<cv::Mat>>;
StackPictureViews pictures_of(const StackView &view, std::span<std::byte> memory);

/* The colour channels of a component that show something: all but the fourth of RGBx. */
int shown_channels(const Component &component);

/* A stack at a fraction of its size, where motion is looked for: of each plane and colour channel a picture
 * of floats, white is 256, each the mean of the samples of `factor` x `factor` pixels. */
class SmallStack {
public:
    /* Pixels. The factor is the least power of two, from 2 on, that makes pictures no wider: 32 at most. */
    static constexpr uint32_t most_width = 512;

    explicit SmallStack(const StackShape &shape);

    /* All of it, or some rows of one channel of one plane. */
    void take(const StackPictureViews &pictures);
    void take(const StackPictureViews &pictures, unsigned z, unsigned channel, const cv::Range &rows);

    /* One plane from another sweep of the same shape. */
    void take(const SmallStack &other, unsigned z);

    int factor() const { return factor_; }
    cv::Size size() const { return size_; }
    unsigned planes() const { return shape_.planes; }
    unsigned channels() const { return static_cast<unsigned>(component_of_.size()); }

    /* Which component of the stack a channel belongs to, and how many samples of it make a pixel here. */
    size_t component_of(unsigned channel) const { return component_of_[channel]; }
    double samples(unsigned channel) const;

    const cv::Mat1f &picture(unsigned z, unsigned channel) const { return pictures_[z][channel]; }

    /* Brightness, for looking for motion. */
    cv::Mat1f luma(unsigned z) const;

private:
    StackShape shape_;
    std::vector<Component> components_;
    int factor_;
    cv::Size size_;
    std::vector<size_t> component_of_;
    std::vector<std::vector<cv::Mat1f>> pictures_; /* [z][channel] */
};

} // namespace dff
