/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_stack.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace dff {

TestStack::TestStack(const StackShape &shape, unsigned seed)
    : shape(shape), layout(packed_layout(shape)), memory(layout.back().offset)
{
    const std::vector<Component> components = shape.components();
    const Component &last = components.back();
    memory.resize(layout.back().offset + layout.back().stride * last.height);

    std::mt19937 random(seed);
    std::uniform_real_distribution<float> texture(-60.0f, 60.0f);
    for (size_t c = 0; c < components.size(); c++) {
        const Component &component = components[c];
        for (unsigned y = 0; y < component.height; y++)
            for (unsigned x = 0; x < component.width * component.sample_bytes; x++) {
                const float value = texture(random);
                const float sharpest = 0.5f * (shape.planes - 1) * (1.0f + std::sin(0.05f * x + 0.03f * y));
                for (unsigned z = 0; z < shape.planes; z++) {
                    const float contrast = 1.0f / (1.0f + std::abs(z - sharpest));
                    const RowLayout &rows = layout[c * shape.planes + z];
                    memory[rows.offset + rows.stride * y + x] =
                        static_cast<std::byte>(std::clamp(128.0f + contrast * value, 0.0f, 255.0f));
                }
            }
    }
}

TestStack stack_with_equal_planes(unsigned first, unsigned equal)
{
    const StackShape shape{PixelFormat::Gray8, 150, 101, 6};
    TestStack stack(shape);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> texture(-60, 60);
    for (unsigned y = 0; y < shape.height; y++)
        for (unsigned x = 0; x < shape.width; x++) {
            const int value = texture(random);
            for (unsigned z = 0; z < shape.planes; z++) {
                const int away = z < first ? first - z : z >= first + equal ? z - first - equal + 1 : 0;
                const RowLayout &rows = stack.layout[z];
                stack.memory[rows.offset + rows.stride * y + x] =
                    static_cast<std::byte>(128 + value / (1 + away));
            }
        }
    return stack;
}

std::shared_ptr<Device> device_with(KernelStyle style)
{
    return std::make_shared<Device>(Device::open("")->device(), style);
}

uint8_t TestStack::sample(size_t component, unsigned x, unsigned y, unsigned z) const
{
    const RowLayout &rows = layout[component * shape.planes + z];
    return static_cast<uint8_t>(memory[rows.offset + rows.stride * y + x]);
}

unsigned TestStack::value(size_t component, unsigned x, unsigned y, unsigned z) const
{
    if (shape.components()[component].sample_bytes == 1)
        return sample(component, x, y, z);
    return sample(component, 2 * x, y, z) + 256 * sample(component, 2 * x + 1, y, z);
}

float TestStack::dn(size_t component, unsigned x, unsigned y, unsigned z) const
{
    const auto found = static_cast<float>(value(component, x, y, z));
    return shape.components()[component].sample_bytes == 1 ? found : found * 255.0f / 65535.0f;
}

} // namespace dff
