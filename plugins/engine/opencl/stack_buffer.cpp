/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/stack_buffer.h"

namespace dff {

StackBuffer::StackBuffer(CommandQueue &queue, StackShape shape)
    : queue_(queue), shape_(shape), bytes_(queue),
      layout_(queue.allocate(shape.components().size() * shape.planes * sizeof(RowLayout)))
{
}

void StackBuffer::assign(const StackView &view)
{
    bytes_.upload(view.memory);
    changed_planes_ = tracker_.changed(view);
    tracker_.forget();
    if (view.layout != host_layout_) {
        host_layout_ = view.layout;
        queue_.commands().enqueueWriteBuffer(layout_, CL_TRUE, 0, host_layout_.size() * sizeof(RowLayout),
                                             host_layout_.data());
    }
}

} // namespace dff
