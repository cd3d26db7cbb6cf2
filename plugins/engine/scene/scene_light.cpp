/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/scene_light.h"

#include <cmath>
#include <numbers>

namespace dff {

/* The mean of 1 + a sin(w t) from t0 to t0 + e is 1 + a (cos(w t0) - cos(w (t0 + e))) / (w e). */
double SceneLight::gain(uint64_t frame, double start_s, double exposure_s) const
{
    const double w = 2.0 * std::numbers::pi * frequency_hz;
    const double wave =
        exposure_s > 0.0 ? (std::cos(w * start_s) - std::cos(w * (start_s + exposure_s))) / (w * exposure_s)
                         : std::sin(w * start_s);
    const bool dimmed = switch_frames > 0 && frame / switch_frames % 2 == 1;
    return (1.0 + flicker * wave) * (dimmed ? 0.5 : 1.0);
}

} // namespace dff
