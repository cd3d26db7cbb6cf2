/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>

#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace dff {

/* The pixels of a stack, mapped, as OpenCV sees them. */
class StackPictures {
public:
    /* Maps `buffer` for as long as this lives. Empty, with `error` set, if the buffer does not hold what
     * `info` says or cannot be mapped. */
    static std::unique_ptr<StackPictures> map(const GstFocalStackInfo &info, GstBuffer *buffer,
                                              GstMapFlags flags, GError **error);
    ~StackPictures();
    StackPictures(const StackPictures &) = delete;
    StackPictures &operator=(const StackPictures &) = delete;

    /* How many pictures make up a plane: 1, 2 for NV12, 3 for I420. */
    unsigned components() const;

    /* Pixels a sample of the component stands for a way: 2 for subsampled chroma, otherwise 1. */
    int step(unsigned component) const;

    /* Component 0 is luma, or all colours. */
    cv::Mat component(unsigned plane, unsigned component) const;

    /* From now on component() gives copies without these pixels. */
    void leave_out(std::span<const cv::Point> bad_pixels);

    /* What each colour channel of the component is without light, or without colour. */
    std::vector<double> black(unsigned component) const;

private:
    struct Place {
        gsize offset[GST_VIDEO_MAX_PLANES];
        gint stride[GST_VIDEO_MAX_PLANES];
    };

    StackPictures(const GstFocalStackInfo &info, GstBuffer *buffer) : info_(info), buffer_(buffer) {}

    /* The numbers of the colour channels in the component, in the order of their bytes; alpha is none. */
    std::vector<guint> channels(unsigned component) const;

    GstFocalStackInfo info_;
    GstBuffer *buffer_;
    GstMapInfo map_ = GST_MAP_INFO_INIT;
    std::vector<Place> planes_;
    std::vector<cv::Mat> copies_; /* of the components of plane after plane; mostly none */
};

} // namespace dff
