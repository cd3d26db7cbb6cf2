/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/bilateral_grid.h"

namespace dff {

/* How a stack becomes depth. */
enum class Method {
    Volume, /* spread the evidence at low resolution, then decide */
    Paper,  /* decide for each pixel, then spread the decisions: Oliva-García 2022, section 2.3 */
};

/* What a place is of where something farther is seen through something thin and near. */
enum class Prefer {
    Clearest, /* the one with more to see */
    Near,
    Far,
};

struct DepthParameters {
    Method method = Method::Volume;
    bool motion_mask = true;   /* leave pixels that moved during the sweep out of the sparse map (3) */
    float entropy_bits = 2.0f; /* entropy along z above which a pixel moved */

    /* Of method=paper. */
    unsigned levels = 3;    /* pictures of falling resolution in the focus measure (2) */
    float tolerance = 1.4f; /* a kept peak stands so many times above the mean over the planes */
    BilateralGrid::Parameters grid;

    /* Of method=volume: pixels of the stack a cell of the volume, in each direction: 2, 4 or 8; 0 = 2 up to
     * 800x600 pixels and 4 above. */
    unsigned scale = 0;
    Prefer prefer = Prefer::Clearest;
};

} // namespace dff
