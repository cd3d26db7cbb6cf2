/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "number_matching.h"

namespace dff {

namespace {

/* Then both streams are taken to be in the same numbering: the other one's beginning was lost. */
constexpr unsigned longest_apart = 16;

NumberMatching::Order compare(uint64_t depth, uint64_t stack)
{
    if (depth == stack)
        return NumberMatching::Order::Same;
    return depth < stack ? NumberMatching::Order::Earlier : NumberMatching::Order::Later;
}

} // namespace

NumberMatching::Order NumberMatching::order(const NumberedTime &depth, const NumberedTime &stack)
{
    const uint64_t depth_restarts = depths_.until(depth.number), stack_restarts = stacks_.until(stack.number);
    if (depth_restarts == stack_restarts) {
        apart_ = 0;
        return compare(depth.number, stack.number);
    }
    if (depth.number == stack.number || apart_ == longest_apart) {
        depths_.set(depth.number, stack_restarts);
        apart_ = 0;
        return compare(depth.number, stack.number);
    }
    apart_++;
    if (depth.time_ns && stack.time_ns)
        return *depth.time_ns < *stack.time_ns ? Order::Earlier : Order::Later;
    return depth_restarts < stack_restarts ? Order::Earlier : Order::Later;
}

} // namespace dff
