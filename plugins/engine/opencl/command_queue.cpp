/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/command_queue.h"

#include "engine/engine_error.h"

#include <algorithm>

namespace dff {

namespace {

constexpr size_t round_up(size_t value, size_t multiple)
{
    return (value + multiple - 1) / multiple * multiple;
}

} // namespace

CommandQueue::CommandQueue(std::shared_ptr<Device> device)
    : device_(std::move(device)), queue_(device_->context(), device_->device(), CL_QUEUE_PROFILING_ENABLE)
{
}

cl::Buffer CommandQueue::allocate(size_t bytes)
{
    if (bytes > device_->largest_allocation())
        throw EngineError(EngineError::Kind::TooLarge,
                          "The OpenCL device " + device_->name() + " takes " +
                              std::to_string(device_->largest_allocation()) + " bytes at once, and " +
                              std::to_string(bytes) +
                              " are needed: use smaller pictures, fewer planes or another device");
    allocated_ += bytes;
    return {device_->context(), CL_MEM_READ_WRITE, bytes};
}

void CommandQueue::enqueue(const cl::Kernel &kernel, const cl::NDRange &size, std::array<size_t, 3> group)
{
    std::array<size_t, 3> items{1, 1, 1};
    std::copy_n(size.get(), size.dimensions(), items.begin());
    if (items[0] == 1)
        group[0] = 1;
    items[0] = round_up(items[0], group[0]);

    cl::Event event;
    if (stages_.empty())
        begin_stage("");
    queue_.enqueueNDRangeKernel(kernel, {}, {items[0], items[1], items[2]}, {group[0], group[1], group[2]},
                                nullptr, &event);
    stages_.back().second.push_back(event);
}

StageTimes CommandQueue::finish()
{
    queue_.finish();

    StageTimes times;
    for (const auto &[name, events] : stages_) {
        double nanoseconds = 0.0;
        for (const cl::Event &event : events)
            nanoseconds += static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                               event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
        times.emplace_back(name, nanoseconds / 1e6);
    }
    stages_.clear();
    return times;
}

} // namespace dff
