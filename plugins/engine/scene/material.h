/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/scene/palette.h"
#include "engine/scene/texture.h"

namespace dff {

enum class Pattern { Plain, Marble, Segments, Checks, Stripes, Rainbow };

/* What a surface looks like, as a function of the point in the solid's own axes. */
struct Material {
    Pattern pattern;
    Color first;
    Color second;
    double wave;  /* length of the pattern's period */
    double gloss; /* strength of the highlight */
    FractalNoise grain;

    Color color(const cv::Vec3d &point) const;
};

} // namespace dff
