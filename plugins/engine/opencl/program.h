/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/device.h"

#include <string>
#include <string_view>

namespace dff {

/* One file of kernels/ for a device, built at its first use in the process. */
class Program {
public:
    /* See ProgramCache::get(). `options` are the preprocessor's: "-DPLANES=6 ...". */
    Program(const Device &device, std::string_view name, const std::string &options = "")
        : program_(device.programs().get(name, options))
    {
    }

    /* A kernel of one's own: its arguments are nobody else's. */
    cl::Kernel kernel(const char *name) const { return {program_, name}; }

private:
    cl::Program program_;
};

} // namespace dff
