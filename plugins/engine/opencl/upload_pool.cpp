/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/upload_pool.h"

namespace dff {

UploadPool::UploadPool(cl::Context context, size_t bytes, size_t device_memory)
    : context_(std::move(context)), bytes_(bytes), left_(device_memory / 4 / bytes)
{
}

std::shared_ptr<cl::Buffer> UploadPool::take()
{
    const std::lock_guard lock(mutex_);
    cl::Buffer buffer;
    if (!free_.empty()) {
        buffer = free_.back();
        free_.pop_back();
    } else if (left_ > 0) {
        buffer = cl::Buffer(context_, CL_MEM_READ_ONLY, bytes_);
        left_--;
    } else {
        return nullptr;
    }
    return {new cl::Buffer(buffer), [pool = shared_from_this()](cl::Buffer *used) {
                pool->give_back(*used);
                delete used;
            }};
}

void UploadPool::give_back(cl::Buffer buffer)
{
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(buffer));
}

} // namespace dff
