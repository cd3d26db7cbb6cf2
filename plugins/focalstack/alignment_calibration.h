/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "focalstack/stack_aligner.h"

#include <string>

namespace dff {

/* The warp of each plane of a rig whose planes always lie the same, from a file (optics/settings_file.h):
 *
 *   image_width, image_height  the size that dx and dy are for, in pixels
 *   planes                     a list, nearest plane first, of
 *     dx, dy                   where the centre of the middle plane's picture lies in this plane, in pixels
 *                              right and down of its centre
 *     scale                    its zoom about the centre, 0.1 to 10
 *     rotation                 degrees, clockwise
 *     matrix                   instead of these four: the homography, 9 numbers row by row
 *
 * which are what `stats` of focalstackalign tells after mode=estimate. */
class AlignmentCalibration {
public:
    /* Throws std::runtime_error with a user's text that names the file and what is wrong with it. */
    static AlignmentCalibration load(const std::string &file);

    /* For stacks of this size. Throws std::runtime_error with a user's text if the file has another number of
     * planes. */
    std::vector<PlaneAlignment> alignments(cv::Size size, unsigned planes) const;

private:
    std::string file_;
    cv::Size size_;
    std::vector<PlaneWarp> warps_;
};

} // namespace dff
