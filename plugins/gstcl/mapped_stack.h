/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/device.h"
#include "engine/stack_shape.h"

#include <gst/dff/dff.h>

namespace dff {

/* The engine's word for caps. */
StackShape stack_shape(const GstFocalStackInfo &info);

/* A focal stack mapped for reading, as long as this lives. Where the device does not work in place its upload
 * is shared with the other elements that get the stack. */
class MappedStack {
public:
    /* Throws std::runtime_error with a user's text if the buffer does not hold what the caps say. */
    MappedStack(const GstFocalStackInfo &info, GstBuffer *buffer, const Device &device);
    ~MappedStack() { gst_buffer_unmap(buffer_, &map_); }

    MappedStack(const MappedStack &) = delete;
    MappedStack &operator=(const MappedStack &) = delete;

    const StackView &view() const { return view_; }

private:
    GstBuffer *buffer_;
    GstMapInfo map_{};
    StackView view_;
};

} // namespace dff
