/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/command_queue.h"

namespace dff {

namespace {

/* Fixed, because every new work-group size is compiled anew by PoCL. */
constexpr size_t group_width = 64;

constexpr size_t round_up(size_t value, size_t multiple)
{
    return (value + multiple - 1) / multiple * multiple;
}

} // namespace

CommandQueue::CommandQueue(std::shared_ptr<Device> device)
    : device_(std::move(device)), queue_(device_->context(), device_->device(), CL_QUEUE_PROFILING_ENABLE)
{
}

void CommandQueue::enqueue(const cl::Kernel &kernel, const cl::NDRange &size)
{
    const size_t *items = size.get();
    const size_t width = items[0] == 1 ? 1 : group_width;
    cl::Event event;

    if (stages_.empty())
        begin_stage("");
    if (size.dimensions() == 1)
        queue_.enqueueNDRangeKernel(kernel, {}, {round_up(items[0], width)}, {width}, nullptr, &event);
    else if (size.dimensions() == 2)
        queue_.enqueueNDRangeKernel(kernel, {}, {round_up(items[0], width), items[1]}, {width, 1}, nullptr,
                                    &event);
    else
        queue_.enqueueNDRangeKernel(kernel, {}, {round_up(items[0], width), items[1], items[2]},
                                    {width, 1, 1}, nullptr, &event);
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
