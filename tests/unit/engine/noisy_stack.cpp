/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "noisy_stack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace dff {

unsigned sample_of(const TestStack &stack, const Component &component, const RowLayout &rows, unsigned x,
                   unsigned y)
{
    unsigned value = 0;
    std::memcpy(&value,
                stack.memory.data() + rows.offset + rows.stride * y + size_t{x} * component.sample_bytes,
                component.sample_bytes);
    return value;
}

void set_sample(TestStack &stack, const Component &component, const RowLayout &rows, unsigned x, unsigned y,
                double value)
{
    const double most = component.sample_bytes == 2 ? 65535.0 : 255.0;
    const auto rounded = static_cast<uint16_t>(std::lround(std::clamp(value, 0.0, most)));
    std::memcpy(stack.memory.data() + rows.offset + rows.stride * y + size_t{x} * component.sample_bytes,
                &rounded, component.sample_bytes);
}

TestStack noisy(const TestStack &clean, double sigma, unsigned seed)
{
    TestStack stack = clean;
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, sigma);
    for_each_sample(clean.shape,
                    [&](size_t c, const Component &component, unsigned z, unsigned x, unsigned y) {
                        const RowLayout &rows = clean.layout[c * clean.shape.planes + z];
                        const double unit = component.sample_bytes == 2 ? 256.0 : 1.0;
                        set_sample(stack, component, rows, x, y,
                                   sample_of(clean, component, rows, x, y) + unit * noise(random));
                    });
    return stack;
}

TestStack smooth_stack(const StackShape &shape, double phase)
{
    TestStack stack(shape);
    for_each_sample(shape, [&](size_t c, const Component &component, unsigned z, unsigned x, unsigned y) {
        const double value = 128 + 50 * std::sin(0.11 * x + 0.07 * y + z + phase);
        set_sample(stack, component, stack.layout[c * shape.planes + z], x, y,
                   component.sample_bytes == 2 ? 256 * value : value);
    });
    return stack;
}

double mean_square(const TestStack &a, const TestStack &b)
{
    double sum = 0.0, count = 0.0;
    for_each_sample(a.shape, [&](size_t c, const Component &component, unsigned z, unsigned x, unsigned y) {
        const RowLayout &rows = a.layout[c * a.shape.planes + z];
        const double unit = component.sample_bytes == 2 ? 256.0 : 1.0;
        const double difference = (static_cast<double>(sample_of(a, component, rows, x, y)) -
                                   static_cast<double>(sample_of(b, component, rows, x, y))) /
                                  unit;
        sum += difference * difference;
        count++;
    });
    return sum / count;
}

} // namespace dff
