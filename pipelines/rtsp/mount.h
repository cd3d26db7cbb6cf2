/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

namespace dff {

/* What can be looked at under one path. */
struct Mount {
    std::string path;
    std::set<std::string>
        outputs; /* of the source that it shows; an appsrc of the same name stands for each */
    std::set<std::string>
        elements; /* that may be missing on a machine, and without which the mount is left out */
    std::map<unsigned, std::string>
        depth_streams;  /* streams whose SDP says what the pixels of this output mean */
    std::string launch; /* with payloaders pay0, pay1, ... */
};

std::span<const Mount> all_mounts();

} // namespace dff
