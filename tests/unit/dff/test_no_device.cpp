/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "test_pipeline.h"

#include <gtest/gtest.h>

/* Run with an OpenCL loader that finds no driver. */
TEST(NoDevice, the_error_says_what_to_install)
{
    for (const char *element :
         {"dffdepth ! fakesink", "tee name=s s. ! queue ! c.stack videotestsrc ! c.depth aifcompose "
                                 "name=c ! fakesink"}) {
        const dff::Outcome outcome =
            dff::run(std::string("lenssweeptestsrc num-buffers=6 ! focalstackmux ! ") + element, 20);
        EXPECT_NE(outcome.error.find("pocl-opencl-icd"), std::string::npos) << outcome.error;
        EXPECT_NE(outcome.error.find("clinfo"), std::string::npos) << outcome.error;
        EXPECT_NE(outcome.error.find("POCL_CACHE_DIR"), std::string::npos) << outcome.error;
    }
}
