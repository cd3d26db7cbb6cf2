/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "bench_camera.h"
#include "sequencer.h"
#include "test_scene.h"

#include <string>

namespace dff {

/* What the command line asks for. */
struct Options {
    cv::Size size{640, 480};
    TestScene scene;
    SequencerSettings sequencer;
    BenchCameraSettings camera;
    Frequency lose_sync;
    std::string run_line;  /* path of its socket; empty: always high */
    std::string sync_line; /* path of its socket; empty: not wired */
    std::string truth;     /* a picture of the true depth to write; empty: none */
};

/* Throws std::invalid_argument with a message for the user; prints the help and exits for --help. */
Options parse_options(int argc, char **argv);

} // namespace dff
