/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/program.h"

#include "engine/engine_error.h"
#include "engine/opencl/kernel_sources.h"

namespace dff {

Program::Program(const Device &device, std::string_view name, const std::string &options)
    : program_(device.context(), std::string(kernel_sources().at("common")).append(kernel_sources().at(name)))
{
    try {
        program_.build({device.device()}, ("-cl-std=CL1.2 " + options).c_str());
    } catch (const cl::Error &) {
        throw EngineError(EngineError::Kind::Failed,
                          "The OpenCL driver of " + device.name() + " cannot compile the kernel " +
                              std::string(name) + ": " +
                              program_.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.device()));
    }
}

} // namespace dff
