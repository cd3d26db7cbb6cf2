/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/stack_buffer.h"

#include "engine/opencl/shared_upload.h"

namespace dff {

StackBuffer::StackBuffer(CommandQueue &queue, StackShape shape)
    : queue_(queue), shape_(shape), own_(queue),
      layout_(queue.allocate(shape.components().size() * shape.planes * sizeof(RowLayout)))
{
}

/* Empty where there is nothing to share. */
std::shared_ptr<cl::Buffer> StackBuffer::upload_shared(const StackView &view)
{
    const Device &device = queue_.device();
    if (!view.upload || device.works_in_place())
        return nullptr;
    if (!uploads_ || uploads_->bytes() != view.memory.size())
        uploads_ = device.uploads(view.memory.size());
    return view.upload->on(queue_, *uploads_, view.memory);
}

void StackBuffer::assign(const StackView &view)
{
    const std::shared_ptr<cl::Buffer> shared = upload_shared(view);
    bytes_ = shared ? *shared : own_.upload(view.memory);
    changed_planes_ = tracker_.changed(view);
    tracker_.forget();
    if (view.layout != host_layout_) {
        host_layout_ = view.layout;
        queue_.commands().enqueueWriteBuffer(layout_, CL_TRUE, 0, host_layout_.size() * sizeof(RowLayout),
                                             host_layout_.data());
    }
}

} // namespace dff
