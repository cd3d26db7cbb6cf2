/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * print_self_test >plugins/engine/self_test_results.h: what the default device makes of the self-test's
 * stack, with one work-item a pixel. To be run by hand after a change of kernels that is meant to change
 * depth, with a driver that passes the tests of the kernels. */
#include "engine/self_test.h"

#include <iostream>

using namespace dff;

namespace {

void print(const char *name, const std::vector<uint8_t> &values)
{
    constexpr size_t row = 34; /* places */
    std::cout << "inline constexpr std::array<uint8_t, " << values.size() << "> " << name << "{\n";
    for (size_t i = 0; i < values.size(); i++)
        std::cout << (i % row ? " " : "    ") << +values[i] << "," << (i % row == row - 1 ? "\n" : "");
    std::cout << "};\n";
}

} // namespace

int main()
{
    const auto device = std::make_shared<Device>(Device::open("")->device(), KernelStyle::Pixels);
    std::cout << "/* SPDX-License-Identifier: LGPL-2.1-or-later\n"
                 " * Copyright (C) 2026 the gst-plugins-dff authors */\n"
                 "#pragma once\n\n"
                 "#include <array>\n"
                 "#include <cstdint>\n\n"
                 "/* Written by tests/unit/engine/print_self_test.cpp. */\n"
                 "namespace dff::self_test {\n\n"
                 "/* clang-format off */\n";
    print("stored_paper", self_test::depth_on(device, Method::Paper));
    print("stored_volume", self_test::depth_on(device, Method::Volume));
    std::cout << "/* clang-format on */\n\n} // namespace dff::self_test\n";
}
