/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>

namespace dff {

/* What cv::warpPerspective() with INTER_LANCZOS4 | WARP_INVERSE_MAP and BORDER_REFLECT_101 does, in a small
 * part of its time: first along the columns, then along the rows, with 8 samples each instead of 8x8 at once
 * (Catmull and Smith, SIGGRAPH 1980). `matrix` brings pixels of `warped` onto those of `plane`; positions are
 * rounded to 1/128 of a pixel, and where the picture turns by a degree to 1/25 along columns.
 *
 * Only for 8 or 16 bits, and for warps as a hand and breathing make them: a turn of a degree, a tenth of
 * zoom, a shift of a quarter of the picture at most. Returns false, without having done anything, for others.
 */
bool warp_nearly_in_place(const cv::Mat &plane, cv::Mat &warped, const cv::Matx33d &matrix);

} // namespace dff
