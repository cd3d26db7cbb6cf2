/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <functional>
#include <gst/check/gstharness.h>
#include <gst/dff/dff.h>
#include <memory>
#include <string>
#include <vector>

namespace dff {

struct HarnessDeleter {
    void operator()(GstHarness *harness) const { gst_harness_teardown(harness); }
};
using Harness = std::unique_ptr<GstHarness, HarnessDeleter>;

struct BufferDeleter {
    void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
};
using Buffer = std::unique_ptr<GstBuffer, BufferDeleter>;

/* A pipeline between two pads; its input is a depth stream of this size in dioptres from 5 to 1. */
Harness depth_harness(const std::string &pipeline, unsigned width, unsigned height);

/* The facts of that stream. */
GstDepthInfo dioptres_from_5_to_1();

using PixelAt = std::function<guint16(unsigned x, unsigned y)>;

/* A depth frame of this size without stride padding (`width` is even), without any meta. */
Buffer depth_frame(unsigned width, unsigned height, const PixelAt &pixel_at);

/* The pixels of such a frame. */
std::vector<guint16> pixels_of(GstBuffer *frame);

/* The caps that come out of the harness, as text. */
std::string caps_string(GstHarness *harness);

} // namespace dff
