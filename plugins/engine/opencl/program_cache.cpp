/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/program_cache.h"

#include "engine/engine_error.h"
#include "engine/opencl/kernel_sources.h"
#include "engine/opencl/program_file.h"

#include <optional>

namespace dff {

ProgramCache::ProgramCache(cl::Context context, cl::Device device)
    : context_(std::move(context)), device_(std::move(device))
{
}

cl::Program ProgramCache::get(std::string_view name, const std::string &options)
{
    const std::lock_guard lock(mutex_);
    cl::Program &program = programs_[std::string(name) + " " + options];
    if (!program())
        program = build(name, options);
    return program;
}

cl::Program ProgramCache::build(std::string_view name, const std::string &options) const
{
    const std::string source = std::string(kernel_sources().at("common")).append(kernel_sources().at(name));
    /* No warnings (-w), which drivers write on the user's terminal: PoCL counts the loops it could not
     * unroll. */
    const std::string all_options = "-cl-std=CL1.2 -w " + options;
    const ProgramFile file(device_.getInfo<CL_DEVICE_NAME>() + "\n" + device_.getInfo<CL_DEVICE_VERSION>() +
                           "\n" + device_.getInfo<CL_DRIVER_VERSION>() + "\n" + all_options + "\n" + source);
    if (const auto binary = file.read()) {
        try {
            cl::Program program(context_, {device_}, {*binary});
            program.build({device_}, all_options.c_str());
            return program;
        } catch (const cl::Error &) {
            /* The driver does not take it any more: built anew. */
        }
    }

    cl::Program program(context_, source);
    try {
        program.build({device_}, all_options.c_str());
    } catch (const cl::Error &) {
        throw EngineError(EngineError::Kind::Failed,
                          "The OpenCL driver of " + device_.getInfo<CL_DEVICE_NAME>() +
                              " cannot compile the kernel " + std::string(name) + ": " +
                              program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_));
    }
    if (const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>(); !binaries.empty())
        file.write(binaries.front());
    return program;
}

} // namespace dff
