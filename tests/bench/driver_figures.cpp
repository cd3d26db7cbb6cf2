/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* dff-driver-figures: the devices there are, one a line. dff-driver-figures DEVICE [times]: what drivers.sh
 * makes a table of, for the device whose name contains DEVICE and the kernels that DFF_KERNELS names: the
 * driver; and for method=paper and method=volume the share of the self-test's places that differ from what is
 * stored, and, if asked for, milliseconds a stack of 1920x1080, N=6. */
#include "engine/engine_error.h"
#include "engine/focus_engine.h"
#include "engine/self_test.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

using namespace dff;

namespace {

double milliseconds(const std::shared_ptr<Device> &device, Method method)
{
    constexpr StackShape shape{PixelFormat::I420, 1920, 1080, 6};
    const std::vector<std::byte> memory = self_test::stack(shape);
    const StackView view{.shape = shape, .memory = memory, .layout = packed_layout(shape)};
    DepthParameters parameters;
    parameters.method = method;
    std::vector<uint16_t> depth(size_t{shape.width} * shape.height);
    DepthOutputs outputs;
    outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), shape.width * sizeof(uint16_t)};
    FocusEngine engine(device, shape, parameters);
    std::vector<double> times;
    for (int i = 0; i < 6; i++) {
        const auto start = std::chrono::steady_clock::now();
        engine.compute(view, outputs);
        times.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::ranges::sort(times);
    return times[times.size() / 2];
}

void list_devices()
{
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    for (const cl::Platform &platform : platforms) {
        std::vector<cl::Device> devices;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error &) {
            continue; /* a driver without a device */
        }
        for (const cl::Device &device : devices)
            std::cout << device.getInfo<CL_DEVICE_NAME>() << "\n";
    }
}

} // namespace

int main(int count, char **arguments)
{
    if (count < 2) {
        list_devices();
        return 0;
    }
    try {
        const std::shared_ptr<Device> device = Device::open(arguments[1]);
        const cl::Device &driver = device->device();
        std::cout << cl::Platform(driver.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>() << " "
                  << driver.getInfo<CL_DRIVER_VERSION>() << "|" << device->name() << std::endl;
        for (const Method method : {Method::Paper, Method::Volume}) {
            const double wrong =
                self_test::difference(self_test::depth_on(device, method), self_test::stored(method));
            std::cout << std::lround(1000.0 * wrong) / 10.0 << std::endl;
            std::cout << (count > 2 ? std::lround(milliseconds(device, method)) : 0) << std::endl;
        }
    } catch (const EngineError &error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
