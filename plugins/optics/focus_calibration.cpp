/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/focus_calibration.h"

#include "optics/settings_file.h"

#include <algorithm>
#include <functional>

namespace dff {

std::optional<FocusCalibration> read_focus_calibration(const std::string &file)
{
    constexpr Range dioptres{-100.0, 1000.0};
    constexpr std::size_t fewest_planes = 2, most_planes = 64;
    const FileEntries entries("The calibration", file);
    if (!entries.has("focus"))
        return std::nullopt;
    const FileEntries focus = entries.entries("focus");
    FocusCalibration calibration;
    calibration.vergences = focus.numbers("vergences", fewest_planes, most_planes, dioptres);
    const auto &vergences = calibration.vergences;
    if (std::adjacent_find(vergences.begin(), vergences.end(), std::less_equal<>()) != vergences.end())
        focus.fail("focus.vergences must fall from plane to plane");
    const std::vector<double> field = focus.numbers("field", 3, 3, dioptres);
    std::copy(field.begin(), field.end(), calibration.field.begin());
    return calibration;
}

} // namespace dff
