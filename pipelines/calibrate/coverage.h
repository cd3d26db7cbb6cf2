/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board_view.h"

#include <set>

namespace dff {

constexpr int parts_of_picture = 9; /* 3x3, row by row */

/* Which of them hold one of these corners. */
std::set<int> parts_with(const std::vector<cv::Point2d> &corners, const cv::Size &picture);

/* Whether a corner that is sharpest at `focus` shows plane z as it is in focus. */
bool is_sharp_in(double focus, std::size_t plane);

/* What boards have not shown yet, in a user's words; empty if they have shown all. */
std::string still_missing(const std::vector<BoardView> &views);

} // namespace dff
