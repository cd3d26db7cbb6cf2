/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gio/gio.h>
#include <string>
#include <vector>

/* A dff-rtsp-server of its own, on a free port of 127.0.0.1. */
class ServerProcess {
public:
    /* Throws std::runtime_error if it does not come up. */
    explicit ServerProcess(const std::string &launch, const std::vector<std::string> &arguments = {});
    ~ServerProcess(); /* ends it, and fails the test if it does not end well */
    ServerProcess(const ServerProcess &) = delete;
    ServerProcess &operator=(const ServerProcess &) = delete;

    /* With a user:password if given. */
    std::string url(const std::string &path, const std::string &account = "") const;

    /* How often `text` stands in what it wrote to stderr. */
    unsigned count_in_log(const std::string &text) const;

    /* Waits until it stands there so often, 20 s at most. */
    bool wait_for_log(const std::string &text, unsigned times) const;

private:
    GSubprocess *process_;
    std::string log_path_;
    std::string origin_; /* scheme://address:port */
};
