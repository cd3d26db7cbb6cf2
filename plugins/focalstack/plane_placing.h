/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "focalstack/stack_aligner.h"

namespace dff {

/* All functions here work on one component of each plane of a stack: its picture, or its chroma with one
 * sample for each `step` x `step` pixels. `aligned` has the sizes and types of `planes`, but other memory. */

/* Whether a plane's own picture is in its place, or at least harmless: a plane without texture. */
bool is_shown(const PlaneAlignment &alignment);

/* Writes what `plane` would show without the warp. Lanczos' kernel, since a softer one takes noise and detail
 * from some planes and not from others. What lies outside of `plane` is undefined. */
void undo_warp(const cv::Mat &plane, cv::Mat aligned, const PlaneWarp &warp, int step = 1);

/* Fills what each plane does not show from its neighbour towards the middle: what lies more than 4 pixels
 * beyond its border with a copy that goes on from the plane without a step, a plane that is not trusted with
 * a softened one, which is never sharper than the plane it comes from, where the depth belongs. */
void fill_hidden(std::span<const cv::Mat> aligned, std::span<const PlaneAlignment> alignments, int step = 1);

} // namespace dff
