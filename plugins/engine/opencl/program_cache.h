/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/opencl.h"

#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace dff {

/* The programs of a device, each built once a process. What the driver built is kept as a file for the next
 * process: drivers with a cache of their own, such as PoCL, still parse OpenCL's 17000 lines of headers for
 * each program before they look it up. Safe to use from several threads. */
class ProgramCache {
public:
    ProgramCache(cl::Context context, cl::Device device);

    /* kernels/common.cl and kernels/NAME.cl built with preprocessor `options`. Throws EngineError with the
     * compiler's log if it does not build. */
    cl::Program get(std::string_view name, const std::string &options);

private:
    cl::Program build(std::string_view name, const std::string &options) const;

    cl::Context context_;
    cl::Device device_;
    std::mutex mutex_; /* guards programs_; held while building, since drivers build one at a time */
    std::map<std::string, cl::Program> programs_;
};

} // namespace dff
