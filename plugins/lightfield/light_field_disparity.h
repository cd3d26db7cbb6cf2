/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_parameters.h"

namespace dff {

/* How far the views of a display differ, in pixels of a view or of the panel: how far that end of the sweep
 * which lies farther from the plane of zero parallax moves between the outermost views, and how far it may
 * and still be as sharp as in that plane. Both are 0 where there is but one view.
 *
 * A display shows sharply what moves by at most one of its spatial samples from one view to the next (Zwicker
 * et al. 2006, "Antialiasing for automultiscopic 3D displays": the depth of field). For views, that is a
 * pixel; for panels, a lens, and the next view is the next subpixel under it, or the next pixel of an array
 * of round lenses. Two views are for an eye each, which sees nothing between them: they have no such limit.
 */
struct LightFieldDisparity {
    LightFieldDisparity() = default;
    LightFieldDisparity(const LightFieldParameters &parameters, PictureSize output);

    double outermost = 0.0;
    double sharp = 0.0;      /* or infinite */
    double sharp_gain = 0.0; /* depth_gain at which outermost is sharp */

    bool is_sharp() const { return outermost <= sharp; }
    bool operator==(const LightFieldDisparity &) const = default;
};

} // namespace dff
