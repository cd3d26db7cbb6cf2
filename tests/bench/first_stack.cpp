/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* dff-first-stack paper|volume: milliseconds from the start of a process's first engine to its first depth
 * map and all-in-focus picture, 1920x1080, N=10. A first run fills the caches of compiled kernels. */
#include "bench_stack.h"
#include "engine/aif_composer.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <iostream>

using namespace dff;

int main(int count, char **arguments)
{
    if (count != 2) {
        std::cerr << "usage: dff-first-stack paper|volume\n";
        return 2;
    }
    const bench::BenchStack stack(1920, 1080, 10);
    DepthParameters parameters;
    parameters.method = std::strcmp(arguments[1], "paper") == 0 ? Method::Paper : Method::Volume;
    std::vector<uint16_t> depth(size_t{stack.shape.width} * stack.shape.height);
    std::vector<std::byte> picture(stack.memory.size() / stack.shape.planes);
    const size_t stride = stack.shape.width * sizeof(uint16_t);

    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const std::clock_t start_processor = std::clock();
    const auto lap = [&](const char *what) {
        const std::chrono::duration<double, std::milli> passed = Clock::now() - start;
        std::cout << "| " << what << " | " << std::lround(passed.count()) << " | "
                  << (std::clock() - start_processor) * 1000 / CLOCKS_PER_SEC << " |\n";
    };
    std::cout << "| method=" << arguments[1] << " | ms since the start | of processors |\n|---|---|---|\n";
    const std::shared_ptr<Device> device = Device::open("");
    lap("device open");
    FocusEngine engine(device, stack.shape, parameters);
    AifComposer composer(device, stack.shape);
    lap("kernels there");
    DepthOutputs outputs;
    outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), stride};
    engine.compute(stack.view(), outputs);
    lap("first depth");
    composer.compose(stack.view(), {std::as_bytes(std::span(depth)), stride}, AifComposer::Blend::Linear,
                     picture, packed_layout({stack.shape.format, stack.shape.width, stack.shape.height, 1}));
    lap("first all-in-focus picture");
}
