/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

/* A light that is not the same in every frame. */
struct SceneLight {
    double flicker = 0.0;        /* amplitude over mean, 0 to 1 */
    double frequency_hz = 100.0; /* of the flicker: twice that of the mains */
    uint64_t switch_frames =
        0; /* after so many frames it is dimmed to half, after as many to full; 0: never */

    bool steady() const { return flicker == 0.0 && switch_frames == 0; }

    /* Mean brightness over an exposure of a frame, relative to that of the steady light. */
    double gain(uint64_t frame, double start_s, double exposure_s) const;
};

} // namespace dff
