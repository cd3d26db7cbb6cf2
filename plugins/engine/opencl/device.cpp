/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/device.h"

#include "engine/engine_error.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>
#include <vector>

namespace dff {

namespace {

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::vector<cl::Device> all_devices()
{
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error &) {
        /* CL_PLATFORM_NOT_FOUND_KHR: there is none, which the caller reports. */
    }

    std::vector<cl::Device> devices;
    for (const cl::Platform &platform : platforms) {
        std::vector<cl::Device> found;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
        } catch (const cl::Error &) {
            continue; /* CL_DEVICE_NOT_FOUND: a driver without its hardware */
        }
        devices.insert(devices.end(), found.begin(), found.end());
    }
    return devices;
}

bool has_name(const cl::Device &device, const std::string &wish)
{
    return lower(device.getInfo<CL_DEVICE_NAME>()).find(lower(wish)) != std::string::npos;
}

cl::Device choose(const std::vector<cl::Device> &devices, const std::string &wish)
{
    const auto is_wished = [&](const cl::Device &device) {
        if (wish.empty())
            return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
        return has_name(device, wish);
    };
    const auto found = std::find_if(devices.begin(), devices.end(), is_wished);
    if (found != devices.end())
        return *found;
    if (wish.empty())
        return devices.front();

    std::string names;
    for (const cl::Device &device : devices)
        names += (names.empty() ? "" : ", ") + device.getInfo<CL_DEVICE_NAME>();
    throw EngineError(EngineError::Kind::NoDevice,
                      "No OpenCL device's name contains \"" + wish + "\". There are: " + names);
}

} // namespace

static bool is_cpu(const cl::Device &device)
{
    return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
}

Device::Device(cl::Device device, std::optional<KernelStyle> style, std::optional<bool> works_in_place)
    : device_(std::move(device)), context_(device_),
      programs_(std::make_unique<ProgramCache>(context_, device_)),
      works_in_place_(works_in_place.value_or(is_cpu(device_))),
      global_memory_(device_.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>()),
      largest_allocation_(device_.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>()), kernel_style_(style)
{
}

KernelStyle Device::kernel_style() const
{
    const std::lock_guard lock(style_mutex_);
    if (!kernel_style_)
        kernel_style_ = choose_kernel_style(*this);
    return *kernel_style_;
}

std::string Device::name() const
{
    return device_.getInfo<CL_DEVICE_NAME>();
}

bool Device::is_called(const std::string &wish) const
{
    return has_name(device_, wish);
}

std::shared_ptr<UploadPool> Device::uploads(size_t bytes) const
{
    const std::lock_guard lock(mutex_);
    std::erase_if(uploads_, [](const auto &entry) { return entry.second.expired(); });
    std::shared_ptr<UploadPool> pool = uploads_[bytes].lock();
    if (!pool)
        uploads_[bytes] = pool = std::make_shared<UploadPool>(context_, bytes, global_memory_);
    return pool;
}

std::shared_ptr<Device> Device::open(const std::string &wish)
{
    /* Guards the list of open devices, and PoCL while it looks for its devices: a second thread that asks
     * meanwhile is told of one without memory. Nothing else is locked under it. */
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    /* Never destroyed: at the process's end the driver may have gone before it. */
    static auto &open_devices = *new std::map<cl_device_id, std::shared_ptr<Device>>;

    const std::vector<cl::Device> devices = all_devices();
    if (devices.empty())
        throw EngineError(
            EngineError::Kind::NoDevice,
            "There is no OpenCL device. Install a driver: pocl-opencl-icd computes on the CPU, GPU makers "
            "have their own; clinfo lists what is found. An installed PoCL gives none where its cache cannot "
            "be written: set POCL_CACHE_DIR, or HOME, to a folder that can");

    const cl::Device chosen = choose(devices, wish);
    std::shared_ptr<Device> &device = open_devices[chosen.get()];
    if (!device) {
        try {
            device = std::make_shared<Device>(chosen);
        } catch (const cl::Error &error) {
            throw EngineError(EngineError::Kind::NoDevice,
                              "The OpenCL device " + chosen.getInfo<CL_DEVICE_NAME>() +
                                  " cannot be opened (error " + std::to_string(error.err()) + ")");
        }
    }
    return device;
}

void translate_errors(const Device &device, const std::function<void()> &work)
{
    try {
        work();
    } catch (const cl::Error &error) {
        switch (error.err()) {
        case CL_MEM_OBJECT_ALLOCATION_FAILURE:
        case CL_OUT_OF_RESOURCES:
        case CL_OUT_OF_HOST_MEMORY:
        case CL_INVALID_BUFFER_SIZE:
            throw EngineError(EngineError::Kind::OutOfMemory,
                              "The OpenCL device " + device.name() +
                                  " ran out of memory: use smaller pictures, fewer planes or another device");
        default:
            throw EngineError(EngineError::Kind::Failed, "The OpenCL device " + device.name() +
                                                             " failed in " + error.what() + " (error " +
                                                             std::to_string(error.err()) + ")");
        }
    }
}

} // namespace dff
