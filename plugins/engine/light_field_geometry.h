/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_parameters.h"

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <vector>

namespace dff {

/* Where the layers of the relief lie under the views, and where rays start. Lengths are pixels of the layers,
 * which are those of the picture, or fewer where the display shows no more; x right, y down, the middle of
 * the first pixel at 0. */
struct LightFieldGeometry {
    LightFieldGeometry(const LightFieldParameters &parameters, PictureSize picture, PictureSize output);

    glm::ivec2 view;   /* pixels of a view in the output: the whole of it but for quilt and views */
    glm::ivec2 layers; /* size of the layers */
    glm::dvec2 scale;  /* layer pixels a pixel of a view */
    glm::dvec2 first;  /* layer position of a view's first pixel */
    double range;      /* height of the near end over the far end of the sweep */
    double lowest;     /* height of the far end; the near end's is lowest + range */
    double reach;      /* the greatest slope of a ray */

    glm::dvec2 start(glm::dvec2 pixel) const { return first + scale * pixel; }

    /* The columns of the layers, also beyond their ends, that rays of a view's row meet between the heights.
     */
    struct Columns {
        int first, count;
    };
    Columns columns() const;
};

/* How far the rays of view `view` of `views` lean, tan of their angle: off-axis cameras side by side, whose
 * pictures coincide in the plane of zero parallax. The first looks from the left, the last from the right,
 * and the angle between them is `cone` radians. A single view looks from the middle. */
double view_slope(unsigned view, unsigned views, double cone);

/* How far, in widths of the panel along its lenses' rows, the subpixel of red, green or blue (0, 1, 2) lies
 * from where its pixel (x from the left, y from the bottom) is counted: a + tilt b of LenticularSheet. The
 * shifts are the same every second pixel along x and every fourth along y. */
double subpixel_shift(const LenticularSheet &sheet, glm::ivec2 pixel, unsigned color, PictureSize panel);

/* Panel pixels to the array's own axes in units of the pitch. */
glm::dmat2 to_lens_matrix(const LensArray &lenses);

/* The gap in panel pixels that the lenses are at. */
double lens_gap(const LightFieldParameters &parameters);

} // namespace dff
