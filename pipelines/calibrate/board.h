/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace dff {

/* A printed chessboard, counted in squares. */
struct Board {
    static constexpr int fewest_squares = 4;
    static constexpr int most_squares = 40;

    int columns = 10;
    int rows = 7;
    double square_mm = 25.0;

    /* Of "COLUMNSxROWSxMILLIMETRES", as 10x7x25; nothing if it is none. */
    static std::optional<Board> parse(const std::string &text);

    /* Where squares meet, row after row. */
    cv::Size corners() const { return {columns - 1, rows - 1}; }
    std::vector<cv::Point3f> corner_points() const; /* metres, on the sheet */

    /* A sheet to print at its own size: the squares, a border as wide as one, and a line of text. */
    std::string sheet() const;
};

} // namespace dff
