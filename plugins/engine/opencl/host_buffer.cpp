/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/host_buffer.h"

namespace dff {

const cl::Buffer &HostBuffer::upload(std::span<const std::byte> memory)
{
    if (queue_.device().works_in_place()) {
        /* OpenCL has no buffers of const host memory; CL_MEM_READ_ONLY keeps the promise. */
        buffer_ = {queue_.device().context(), CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, memory.size(),
                   const_cast<std::byte *>(memory.data())};
        return buffer_;
    }
    keep(memory.size());
    queue_.commands().enqueueWriteBuffer(buffer_, CL_FALSE, 0, memory.size(), memory.data());
    return buffer_;
}

const cl::Buffer &HostBuffer::target(std::span<std::byte> memory)
{
    if (queue_.device().works_in_place())
        buffer_ = {queue_.device().context(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, memory.size(),
                   memory.data()};
    else
        keep(memory.size());
    return buffer_;
}

void HostBuffer::download(std::span<std::byte> memory)
{
    if (!queue_.device().works_in_place())
        queue_.commands().enqueueReadBuffer(buffer_, CL_FALSE, 0, memory.size(), memory.data());
}

void HostBuffer::keep(size_t bytes)
{
    if (kept_ == bytes)
        return;
    buffer_ = {}; /* two of them need not fit */
    buffer_ = queue_.allocate(bytes);
    kept_ = bytes;
}

} // namespace dff
