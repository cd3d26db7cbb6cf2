/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/opencl.h"

#include <memory>
#include <mutex>
#include <vector>

namespace dff {

/* Buffers of one size on a discrete device, for stacks that several engines read. Those that are given back
 * are used again. They take at most a quarter of the device's memory, so that stacks that wait somewhere do
 * not fill it. Any thread. */
class UploadPool : public std::enable_shared_from_this<UploadPool> {
public:
    UploadPool(cl::Context context, size_t bytes, size_t device_memory);

    size_t bytes() const { return bytes_; }

    /* A buffer that comes back by itself; the commands that use it must have ended by then. Empty if all are
     * in use. Throws cl::Error. */
    std::shared_ptr<cl::Buffer> take();

private:
    void give_back(cl::Buffer buffer);

    cl::Context context_;
    size_t bytes_;
    std::mutex mutex_; /* a leaf; guards the rest */
    size_t left_;      /* buffers that may still be made */
    std::vector<cl::Buffer> free_;
};

} // namespace dff
