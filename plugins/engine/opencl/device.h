/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/kernel_style.h"
#include "engine/opencl/opencl.h"
#include "engine/opencl/program_cache.h"
#include "engine/opencl/upload_pool.h"

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace dff {

/* An OpenCL device with its context, shared by all engines that use it. */
class Device {
public:
    /* Opens the device whose name contains `wish`, ignoring case; with an empty wish the first GPU, else the
     * first device. Engines in one process that ask for the same device share it, and it stays open for those
     * that come later. Throws EngineError (NoDevice) with the list of devices if there is none. */
    static std::shared_ptr<Device> open(const std::string &wish);

    /* A device of one's own. Without a style it uses the one it computes rightly with; CPUs work in place
     * unless told otherwise. */
    explicit Device(cl::Device device, std::optional<KernelStyle> style = std::nullopt,
                    std::optional<bool> works_in_place = std::nullopt);

    const cl::Device &device() const { return device_; }
    const cl::Context &context() const { return context_; }
    ProgramCache &programs() const { return *programs_; }
    std::string name() const;

    /* The pool for stacks of this size, which lives as long as somebody has it. */
    std::shared_ptr<UploadPool> uploads(size_t bytes) const;

    /* The name contains `wish`, ignoring case. */
    bool is_called(const std::string &wish) const;

    /* The device works in the host's memory, so that stacks need not be copied to it. */
    bool works_in_place() const { return works_in_place_; }

    /* At the first call without a style of one's own, see choose_kernel_style(): may take long, and throw
     * EngineError. Every engine asks before it builds kernels. */
    KernelStyle kernel_style() const;

    size_t global_memory() const { return global_memory_; }
    size_t largest_allocation() const { return largest_allocation_; }

private:
    cl::Device device_;
    cl::Context context_;
    std::unique_ptr<ProgramCache> programs_;
    bool works_in_place_;
    size_t global_memory_;
    size_t largest_allocation_;

    mutable std::mutex style_mutex_; /* held while the style is found; guards it */
    mutable std::optional<KernelStyle> kernel_style_;

    mutable std::mutex mutex_; /* a leaf; guards the pools */
    mutable std::map<size_t, std::weak_ptr<UploadPool>> uploads_;
};

/* Runs `work` and turns what the OpenCL driver throws into EngineError. */
void translate_errors(const Device &device, const std::function<void()> &work);

} // namespace dff
