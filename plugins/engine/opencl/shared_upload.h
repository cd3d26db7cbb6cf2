/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/command_queue.h"
#include "engine/opencl/upload_pool.h"

#include <mutex>
#include <span>
#include <vector>

namespace dff {

/* The bytes of one stack on discrete devices: on each the first engine that wants them uploads them, the
 * others use what it uploaded. It must live until the commands of all of them have ended, and the stack's
 * memory must not change as long. Any thread. */
class SharedUpload {
public:
    SharedUpload() = default;
    ~SharedUpload();

    SharedUpload(const SharedUpload &) = delete;
    SharedUpload &operator=(const SharedUpload &) = delete;

    /* A buffer of `pool` that holds `memory` for the commands enqueued to `queue` from here on. Empty if the
     * pool has none left. Throws cl::Error. */
    std::shared_ptr<cl::Buffer> on(CommandQueue &queue, UploadPool &pool, std::span<const std::byte> memory);

private:
    struct Copy {
        cl::Context context;
        std::shared_ptr<cl::Buffer> buffer;
        cl::Event written;
    };

    std::mutex mutex_; /* the pool's is locked under it */
    std::vector<Copy> copies_;
};

} // namespace dff
