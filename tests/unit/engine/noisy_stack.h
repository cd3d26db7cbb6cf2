/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "test_stack.h"

namespace dff {

/* One sample of a component of one plane, whose rows lie so. What is set is rounded and clipped. */
unsigned sample_of(const TestStack &stack, const Component &component, const RowLayout &rows, unsigned x,
                   unsigned y);
void set_sample(TestStack &stack, const Component &component, const RowLayout &rows, unsigned x, unsigned y,
                double value);

template <typename Work> void for_each_sample(const StackShape &shape, const Work &work)
{
    const auto components = shape.components();
    for (size_t c = 0; c < components.size(); c++)
        for (unsigned z = 0; z < shape.planes; z++)
            for (unsigned y = 0; y < components[c].height; y++)
                for (unsigned x = 0; x < components[c].width; x++)
                    work(c, components[c], z, x, y);
}

/* `clean` with normal noise of a standard deviation in units of which white has 256. */
TestStack noisy(const TestStack &clean, double sigma, unsigned seed);

/* Soft pictures, which leave room for noise at both ends. */
TestStack smooth_stack(const StackShape &shape, double phase = 0.0);

/* Of the difference of two stacks, over all samples, in the same units. */
double mean_square(const TestStack &a, const TestStack &b);

} // namespace dff
