/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "accounts.h"
#include "fuzz.h"

#include <gst/gst.h>

extern "C" int LLVMFuzzerInitialize(int *, char ***)
{
    gst_init(nullptr, nullptr);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dff::read_as_file(data, size, [](std::string path) {
        std::string program = "dff-rtsp-server", option = "--accounts";
        char *argv[] = {program.data(), option.data(), path.data(), nullptr};
        const dff::ServerOptions options = dff::parse_options(3, argv);
        dff::require(!options.accounts.empty());
        for (const auto &[user, password] : options.accounts)
            dff::require(!user.empty() && !password.empty());
        dff::require(dff::make_auth(options) != nullptr);
    });
    return 0;
}
