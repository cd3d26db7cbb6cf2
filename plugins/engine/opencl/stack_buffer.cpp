/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/stack_buffer.h"

#include "engine/engine_error.h"
#include "engine/opencl/shared_upload.h"

namespace dff {

namespace {

std::string as_text(uint64_t bytes)
{
    return std::to_string(bytes) + " bytes (" + std::to_string(bytes >> 20) + " MiB)";
}

StackShape with_room(const Device &device, const StackShape &shape)
{
    require_room(device, shape);
    return shape;
}

} // namespace

void require_room(const Device &device, const StackShape &shape)
{
    const uint64_t bytes = bytes_of(shape);
    if (bytes <= device.global_memory() / 2 && bytes <= device.largest_allocation())
        return;
    throw EngineError(EngineError::Kind::TooLarge,
                      "A stack of " + std::to_string(shape.planes) + " planes of " +
                          std::to_string(shape.width) + "x" + std::to_string(shape.height) + " has " +
                          as_text(bytes) + "; the OpenCL device " + device.name() + " has " +
                          as_text(device.global_memory()) + ", of which half may be used, and takes " +
                          as_text(device.largest_allocation()) +
                          " at once: use smaller pictures, fewer planes or another device");
}

StackBuffer::StackBuffer(CommandQueue &queue, StackShape shape)
    : queue_(queue), shape_(with_room(queue.device(), shape)), own_(queue),
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
    if (view.shape != shape_ || !lies_within_memory(view))
        throw EngineError(EngineError::Kind::Failed,
                          "The stack is not of the shape or the size it was said to be");
    const std::shared_ptr<cl::Buffer> shared = upload_shared(view);
    bytes_ = shared ? *shared : own_.upload(view.memory);
    changed_planes_ = tracker_.changed(view);
    noise_ = view.noise;
    tracker_.forget();
    if (view.layout != host_layout_) {
        host_layout_ = view.layout;
        queue_.commands().enqueueWriteBuffer(layout_, CL_TRUE, 0, host_layout_.size() * sizeof(RowLayout),
                                             host_layout_.data());
    }
}

} // namespace dff
