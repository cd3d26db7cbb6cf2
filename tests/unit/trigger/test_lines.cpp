/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/trigger/lines.h"

#include <gtest/gtest.h>

/* What there is to be seen without a GPIO chip; tests/rig/vm has one. */

TEST(Lines, missing_line_is_an_error_that_says_what_to_do)
{
    for (const char *name : {"DFF-NO-SUCH-LINE", "gpiochip-none:5", "/dev/null:5",
                             "gpiochip0:", "gpiochip0:-1", "gpiochip0:x", "gpiochip0:999999999", ""}) {
        for (const bool output : {true, false}) {
            try {
                if (output) {
                    dff::open_output_line(name);
                } else {
                    dff::open_edge_line(name);
                }
                ADD_FAILURE() << name;
            } catch (const dff::LineError &error) {
                const std::string message = error.what();
                EXPECT_NE(message.find("gpio"), std::string::npos) << message;
            }
        }
    }
}
