/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/device.h"

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dff {

/* Milliseconds the device spent in each stage, in the order they ran. */
using StageTimes = std::vector<std::pair<std::string, double>>;

/* An in-order queue of kernels that adds up their times by stage. */
class CommandQueue {
public:
    explicit CommandQueue(std::shared_ptr<Device> device);

    const Device &device() const { return *device_; }
    cl::CommandQueue &commands() { return queue_; }

    /* Throws EngineError (TooLarge) if the device does not take so much at once. */
    cl::Buffer allocate(size_t bytes);

    /* Bytes of all buffers so far, given back or not. */
    uint64_t allocated() const { return allocated_; }

    /* Kernels run from here on belong to the stage `name`. */
    void begin_stage(const char *name) { stages_.emplace_back(name, std::vector<cl::Event>()); }

    /* Runs `kernel` over a picture of width x height x depth work-items, one for each; the kernel must return
     * at once for items outside, since the range is rounded up to whole work-groups. */
    template <typename... Arguments>
    void run(cl::Kernel &kernel, const cl::NDRange &size, const Arguments &...arguments)
    {
        cl_uint index = 0;
        (kernel.setArg(index++, arguments), ...);
        enqueue(kernel, size, {group_width, 1, 1});
    }

    /* Runs `kernel` once for each of `size`, in work-groups of one: for kernels that work on a tile or a row.
     */
    template <typename... Arguments>
    void run_groups(cl::Kernel &kernel, const cl::NDRange &size, const Arguments &...arguments)
    {
        cl_uint index = 0;
        (kernel.setArg(index++, arguments), ...);
        enqueue(kernel, size, {1, 1, 1});
    }

    /* Waits for all kernels and returns the times of the stages since the last call. */
    StageTimes finish();

private:
    /* Fixed, because every new work-group size is compiled anew by PoCL. */
    static constexpr size_t group_width = 64;

    void enqueue(const cl::Kernel &kernel, const cl::NDRange &size, std::array<size_t, 3> group);

    std::shared_ptr<Device> device_;
    cl::CommandQueue queue_;
    uint64_t allocated_ = 0;
    std::vector<std::pair<std::string, std::vector<cl::Event>>> stages_;
};

} // namespace dff
