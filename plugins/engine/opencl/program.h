/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/device.h"

#include <string>
#include <string_view>

namespace dff {

/* One file of kernels/, built for a device. */
class Program {
public:
    /* Builds kernels/common.cl and kernels/NAME.cl with preprocessor `options` ("-DPLANES=6 ...").
     * Throws EngineError with the compiler's log if it does not build. */
    Program(const Device &device, std::string_view name, const std::string &options = "");

    cl::Kernel kernel(const char *name) const { return {program_, name}; }

private:
    cl::Program program_;
};

} // namespace dff
