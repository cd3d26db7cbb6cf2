/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board.h"

#include <optional>
#include <string>
#include <vector>

namespace dff {

struct Options {
    Board board;
    std::string sheet;
    std::vector<std::string> sources; /* descriptions for gst-launch-1.0 */
    std::string points;               /* of a lens, as LensPoints has them */
    std::string lens = "lens";
    std::string profile;             /* a lens profile to write beside the calibration */
    std::optional<std::string> like; /* the one that it takes after */
    std::string output = "calibration.yml";
    std::string check;
    std::string plots;
    unsigned boards = 12; /* after which no more are looked for */
};

/* Takes its own and GStreamer's options. Throws std::invalid_argument with a user's text. */
Options parse_options(int argc, char **argv);

} // namespace dff
