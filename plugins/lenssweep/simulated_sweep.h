/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/swept_camera.h"
#include "picture_converter.h"

#include <functional>
#include <gst/video/video.h>
#include <memory>
#include <stop_token>
#include <vector>

/* The simulated camera's pictures as buffers of one video format. What does not change from sweep to sweep is
 * rendered once, in the constructor, and its memory is shared by all buffers that show it; noise is drawn
 * anew for each frame. */
class SimulatedSweep {
public:
    /* Told of each plane that is rendered. */
    using Progress = std::function<void(unsigned plane, unsigned planes)>;

    /* `steady_light`: frames are asked for with a gain of 1 only. Where `stop` was requested nothing is
     * usable. */
    SimulatedSweep(dff::SweptCamera camera, const GstVideoInfo &info, bool steady_light,
                   const std::stop_token &stop, const Progress &progress);

    /* The picture of one plane in `gain` times the light, without time or metas; its memory is read-only. */
    GstBuffer *frame(guint64 sweep, guint plane, double gain) const;

    /* The true depth, GRAY16_LE. */
    GstBuffer *depth(guint64 sweep) const;

    /* The true motion, RGBA64_LE: R and G are 32768 + 64 times the pixels a plane to the right and down, B
     * and A are white. */
    GstBuffer *motion(guint64 sweep) const;

private:
    struct BufferUnref {
        void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
    };
    using Buffer = std::unique_ptr<GstBuffer, BufferUnref>;

    GstBuffer *new_frame(guint64 sweep, guint plane, double gain) const;
    GstBuffer *make_depth(guint64 sweep) const;

    dff::SweptCamera camera_;
    PictureConverter converter_;
    GstVideoInfo depth_info_, motion_info_;
    /* Plane after plane: buffers if every sweep is the same, else what each frame begins with. */
    std::vector<Buffer> frames_;
    std::vector<cv::Mat3f> exposed_;
    Buffer depth_; /* if nothing moves */
};
