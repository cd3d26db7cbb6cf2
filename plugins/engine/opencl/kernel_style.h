/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <functional>

namespace dff {

class Device;

/* The kernels that suit a device: one work-item a pixel, or one a tile or row with 16 lanes of integers. */
enum class KernelStyle { Pixels, Tiles };

/* The style that a device is known to compute rightly with: tiles on CPUs whose driver is known to be good
 * with them, else pixels; or what the environment variable DFF_KERNELS (tiles or pixels) says. The first time
 * that a driver is met, it computes the stack of self_test.h; what came out is kept beside its compiled
 * kernels. Throws EngineError, which names the driver, where it computes wrong in every style. Any thread;
 * may take a minute. */
KernelStyle choose_kernel_style(const Device &device);

/* The same with another self-test. */
KernelStyle choose_kernel_style(const Device &device, const std::function<bool(KernelStyle)> &passes);

} // namespace dff
