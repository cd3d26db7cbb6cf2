/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "board.h"

#include <charconv>
#include <sstream>

namespace dff {

namespace {

template <typename Number> bool take(const char *&begin, const char *end, Number &number)
{
    const auto [after, error] = std::from_chars(begin, end, number);
    begin = after;
    return error == std::errc();
}

bool take_separator(const char *&begin, const char *end)
{
    return begin != end && *begin++ == 'x';
}

} // namespace

std::optional<Board> Board::parse(const std::string &text)
{
    Board board;
    const char *at = text.data(), *const end = at + text.size();
    const bool whole = take(at, end, board.columns) && take_separator(at, end) && take(at, end, board.rows) &&
                       take_separator(at, end) && take(at, end, board.square_mm) && at == end;
    const auto is_count = [](int squares) { return squares >= fewest_squares && squares <= most_squares; };
    constexpr double largest_square_mm = 1e4;
    const bool is_square = board.square_mm > 0.0 && board.square_mm <= largest_square_mm;
    if (!whole || !is_count(board.columns) || !is_count(board.rows) || !is_square)
        return std::nullopt;
    return board;
}

std::vector<cv::Point3f> Board::corner_points() const
{
    std::vector<cv::Point3f> points;
    const auto square_m = static_cast<float>(square_mm / 1e3);
    for (int y = 0; y < corners().height; y++)
        for (int x = 0; x < corners().width; x++)
            points.emplace_back(static_cast<float>(x) * square_m, static_cast<float>(y) * square_m, 0.0F);
    return points;
}

std::string Board::sheet() const
{
    constexpr double text_mm = 4.0;
    const double width = (columns + 2) * square_mm, height = (rows + 2) * square_mm;
    std::ostringstream svg;
    svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "mm\" height=\"" << height
        << "mm\" viewBox=\"0 0 " << width << ' ' << height << "\">\n<rect width=\"" << width << "\" height=\""
        << height << "\" fill=\"white\"/>\n";
    for (int row = 0; row < rows; row++)
        for (int column = row % 2; column < columns; column += 2)
            svg << "<rect x=\"" << (column + 1) * square_mm << "\" y=\"" << (row + 1) * square_mm
                << "\" width=\"" << square_mm << "\" height=\"" << square_mm << "\"/>\n";
    svg << "<text x=\"" << square_mm << "\" y=\"" << height - square_mm / 4 << "\" font-size=\"" << text_mm
        << "\">" << columns << " x " << rows << " squares of " << square_mm
        << " mm: print at 100 %, measure a row, mount it flat</text>\n</svg>\n";
    return svg.str();
}

} // namespace dff
