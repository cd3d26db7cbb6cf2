/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/command_queue.h"

#include <span>

namespace dff {

/* Host memory as kernels see it: itself where the device works in place, else a copy in a buffer that is kept
 * from one call to the next. The memory must stay valid until the queue is finished. */
class HostBuffer {
public:
    explicit HostBuffer(CommandQueue &queue) : queue_(queue) {}

    /* For kernels that read. */
    const cl::Buffer &upload(std::span<const std::byte> memory);

    /* For kernels that write all of it; download() once they are enqueued. */
    const cl::Buffer &target(std::span<std::byte> memory);
    void download(std::span<std::byte> memory);

    const cl::Buffer &buffer() const { return buffer_; }

private:
    void keep(size_t bytes);

    CommandQueue &queue_;
    cl::Buffer buffer_;
    size_t kept_ = 0; /* bytes */
};

} // namespace dff
