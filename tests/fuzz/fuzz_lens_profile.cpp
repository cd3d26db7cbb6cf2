/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fuzz.h"
#include "optics/lens_profile.h"

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dff::read_as_file(data, size, [](const std::string &path) {
        const auto profile = dff::LensProfile::load(path);
        for (const double part : {0.0, 0.25, 0.5, 1.0}) {
            const double drive = profile.drive(std::lerp(profile.farthest(), profile.nearest(), part));
            dff::require(drive >= 0.0 && drive <= 1000.0);
        }
        dff::require(profile.settle().count() >= 0 && profile.overdrive_delay().count() >= 0);
    });
    return 0;
}
