/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <gtest/gtest.h>

/* Run with an OpenCL device of 1 GiB. */

TEST(SmallDevice, a_stack_over_half_of_the_memory_is_refused)
{
    const std::vector<guint8> blob(size_t{4096} * 4096 * 40 * 1, 90);
    const std::string file = dff::write_file("large", blob);
    const dff::Outcome outcome =
        dff::run("multifilesrc num-buffers=1 location=" + file +
                 " caps=\"video/x-focal-stack,"
                 "format=GRAY8,width=4096,height=4096,planes=40,framerate=1/1\" ! dffdepth ! fakesink");
    EXPECT_NE(outcome.error.find("640 MiB"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("fewer planes"), std::string::npos) << outcome.error;
}

TEST(SmallDevice, running_out_of_memory_is_an_error_that_says_what_to_do)
{
    const std::vector<guint8> blob(size_t{8192} * 8192 * 3, 90);
    const std::string file = dff::write_file("medium", blob);
    const dff::Outcome outcome = dff::run(
        "multifilesrc num-buffers=1 location=" + file +
        " caps=\"video/x-focal-stack,"
        "format=GRAY8,width=8192,height=8192,planes=3,framerate=1/1\" ! dffdepth method=volume ! fakesink");
    EXPECT_NE(outcome.error.find("smaller pictures"), std::string::npos) << outcome.error;
}
