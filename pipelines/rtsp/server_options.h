/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <map>
#include <string>

namespace dff {

/* Each takes a thread, and open files. */
inline constexpr int most_clients = 10000;

/* What the command line says. */
struct ServerOptions {
    std::string launch; /* the source pipeline; see SourcePipeline */
    std::string address = "0.0.0.0";
    int port = 8554;
    int max_clients = 32;                        /* up to most_clients */
    std::map<std::string, std::string> accounts; /* user -> password; empty: anyone may look */
    bool basic = false;      /* whether passwords may come in the clear; with a certificate they never do */
    std::string certificate; /* PEM file with certificate and key; empty: no TLS */
};

/* Ends the program after --help. Throws std::invalid_argument, with a text for the user, if the options make
 * no sense. */
ServerOptions parse_options(int argc, char **argv);

} // namespace dff
