/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens.h"
#include "lens_property.h"
#include "lens_uri.h"

#include <functional>
#include <memory>
#include <string>

namespace dff {

class CameraFeatures;

/* What a lens may need besides its URI. */
struct LensSurroundings {
    /* File of a LensProfile (fpga, max14574; empty for the one shipped) or of FocusPoints (the others). */
    std::string profile;
    CameraFeatures *features = nullptr; /* of the camera, for genicam; it outlives the lens */

    /* For element: the property of the element with this name; throws LensError if there is none. */
    std::function<std::unique_ptr<LensProperty>(const std::string &element, const std::string &property)>
        find_property = {};

    bool by_itself = false; /* it is to sweep by itself, if it can do both */
};

/* Opens a lens; what comes is a SequencedLens (fpga), another SweptLens (optotune by itself), a Lens that
 * nobody moves (none), or else a SteppedLens. Throws LensError if the device is missing or something else,
 * std::invalid_argument for a profile that cannot be used, or given for a lens that has none. */
std::unique_ptr<Lens> open_lens(const LensUri &uri, const LensSurroundings &surroundings);

} // namespace dff
