/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/swept_camera.h"

#include <gst/video/video.h>
#include <memory>
#include <stop_token>
#include <vector>

/* The simulated camera's pictures as buffers of one video format. What does not change from sweep to sweep is
 * rendered once, in the constructor, and its memory is shared by all buffers that show it. */
class SimulatedSweep {
public:
    /* Different noise is shown in this many sweeps, which then repeat. */
    static constexpr unsigned noise_realisations = 4;

    /* Where `stop` was requested nothing is usable. */
    SimulatedSweep(dff::SweptCamera camera, const GstVideoInfo &info, const std::stop_token &stop);

    /* The picture of one plane, without time or metas; its memory is read-only. */
    GstBuffer *frame(guint64 sweep, guint plane) const;

    /* The true depth, GRAY16_LE. */
    GstBuffer *depth(guint64 sweep) const;

private:
    struct BufferUnref {
        void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
    };
    using Buffer = std::unique_ptr<GstBuffer, BufferUnref>;

    dff::SweptCamera camera_;
    std::vector<Buffer> frames_; /* plane after plane of one realisation after the other */
    Buffer depth_;
};
