/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "capture.h"
#include "server_options.h"

#include <gst/rtsp-server/rtsp-server.h>
#include <string>
#include <vector>

namespace dff {

/* The RTSP server: its mounts, its accounts, and how many clients it takes. Lives in the default main
 * context. */
class Server {
public:
    /* Listens from here on. Throws std::invalid_argument or std::runtime_error, with a
     * text for the user, if the certificate cannot be read or the port cannot be had. */
    Server(const ServerOptions &options, std::shared_ptr<Capture> capture);
    ~Server(); /* waits a moment until the clients are gone */
    Server(const Server &) = delete;
    Server &operator=(const Server &) = delete;

    /* One a mount. */
    std::vector<std::string> urls() const;

private:
    void add_mounts(bool with_auth, bool tcp_only);
    void clean_up_regularly(); /* sessions that timed out */

    const std::shared_ptr<Capture> capture_;
    ObjectPointer<GstRTSPServer> server_;
    std::string scheme_;
    std::vector<std::string> paths_;
    guint accept_source_ = 0;
    guint cleanup_source_ = 0;
};

} // namespace dff
