/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "focalstack/stack_aligner.h"

namespace dff {

/* What makes a channel as bright as that of another plane: v goes to gain * v + offset. */
struct Brightness {
    double gain = 1.0;
    double offset = 0.0; /* in the units of the pixels */

    double apply(double value) const { return gain * value + offset; }
};

/* For each plane and channel what makes it as bright as the plane of the middle gain. `aligned` is one
 * component of each plane, in its place; `black` the value of each channel without light, or without colour.
 *
 * Each plane is held against its neighbour towards the middle where both are shown and neither is clipped: a
 * line through the means over some thousand cells, which are too large to feel blur. It errs in both
 * directions (total least squares), and cells that stray count less, those of moving things too. Where a
 * picture is flat, it is taken that only its gain differs. */
std::vector<std::vector<Brightness>> find_brightness(std::span<const cv::Mat> aligned,
                                                     std::span<const PlaneAlignment> alignments,
                                                     std::span<const double> black, int step = 1);

/* Gives each plane that brightness. Planes in which that would change no pixel by half of a 255th of what it
 * can hold are left as they are. */
void even_brightness(std::span<const cv::Mat> aligned, std::span<const PlaneAlignment> alignments,
                     std::span<const double> black, int step = 1);

} // namespace dff
