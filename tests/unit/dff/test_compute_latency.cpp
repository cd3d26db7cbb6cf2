/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/compute_latency.h"

#include <gtest/gtest.h>

using dff::ComputeLatency;

TEST(ComputeLatency, grows_with_the_longest_stack)
{
    ComputeLatency latency;
    EXPECT_TRUE(latency.add(100 * GST_MSECOND, true));
    EXPECT_FALSE(latency.add(30 * GST_MSECOND, false));
    EXPECT_FALSE(latency.add(120 * GST_MSECOND, false)) << "within the room that was announced";
    EXPECT_TRUE(latency.add(2 * GST_SECOND, false));
    EXPECT_EQ(latency.get(), 2 * GST_SECOND);
}

TEST(ComputeLatency, compiling_kernels_for_the_first_stack_is_none)
{
    ComputeLatency latency;
    EXPECT_FALSE(latency.add(9 * GST_SECOND, true));
    EXPECT_TRUE(latency.add(30 * GST_MSECOND, false));
    EXPECT_EQ(latency.get(), 30 * GST_MSECOND);
    EXPECT_FALSE(latency.add(9 * GST_SECOND, true)) << "another format came, and with it another engine";
    EXPECT_EQ(latency.get(), 30 * GST_MSECOND);
}
