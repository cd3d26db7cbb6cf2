/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace dff {

/* Where the planes of a sweep are sharp: `vergences` holds one a plane, in dioptres, falling, for the
 * picture's centre. The field of the lens adds field[0] x + field[1] y + field[2] (x^2 + y^2) to all of them
 * elsewhere, x and y being the distance from the centre, right and down, in half diagonals of the picture. */
struct FocusCalibration {
    std::vector<double> vergences;
    std::array<double, 3> field{};

    bool is_flat() const { return field == std::array<double, 3>{}; }

    bool operator==(const FocusCalibration &) const = default;
};

/* Reads `focus` (vergences, field) of a camera's calibration file, as dff-calibrate writes it; nothing if the
 * file has none. Throws std::runtime_error with a user's text. */
std::optional<FocusCalibration> read_focus_calibration(const std::string &file);

} // namespace dff
