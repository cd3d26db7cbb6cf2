/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/alignment_calibration.h"
#include "fuzz.h"

#include <cmath>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dff::read_as_file(data, size, [](const std::string &path) {
        const auto calibration = dff::AlignmentCalibration::load(path);
        for (unsigned planes = 1; planes <= 64; planes++)
            try {
                for (const dff::PlaneAlignment &plane : calibration.alignments({8192, 64}, planes))
                    dff::require(plane.warp.scale() > 0.05 &&
                                 std::isfinite(plane.warp.shift().x + plane.warp.shift().y));
            } catch (const std::runtime_error &) {
                continue; /* another number of planes */
            }
    });
    return 0;
}
