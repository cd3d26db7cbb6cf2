/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/shared_upload.h"

#include <algorithm>

namespace dff {

/* An engine that failed may have left before its upload was done. */
SharedUpload::~SharedUpload()
{
    for (const Copy &copy : copies_)
        clWaitForEvents(1, &copy.written());
}

std::shared_ptr<cl::Buffer> SharedUpload::on(CommandQueue &queue, UploadPool &pool,
                                             std::span<const std::byte> memory)
{
    const std::lock_guard lock(mutex_);
    const cl::Context &context = queue.device().context();
    const auto copy = std::find_if(copies_.begin(), copies_.end(),
                                   [&](const Copy &other) { return other.context() == context(); });
    if (copy != copies_.end()) {
        const std::vector<cl::Event> written{copy->written};
        queue.commands().enqueueBarrierWithWaitList(&written);
        return copy->buffer;
    }

    std::shared_ptr<cl::Buffer> buffer = pool.take();
    if (!buffer)
        return nullptr;
    cl::Event written;
    queue.commands().enqueueWriteBuffer(*buffer, CL_FALSE, 0, memory.size(), memory.data(), nullptr,
                                        &written);
    queue.commands().flush(); /* other queues may wait for it now */
    copies_.push_back({context, buffer, written});
    return buffer;
}

} // namespace dff
