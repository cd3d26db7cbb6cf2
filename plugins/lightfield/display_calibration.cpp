/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "display_calibration.h"

#include "light_field_settings.h"
#include "optics/settings_file.h"

#include <array>
#include <cmath>
#include <numbers>

namespace dff {

namespace {

constexpr Range flag{0.0, 1.0};

/* The number in a field, which may be that of a map's `value`. */
double number(const FileEntries &fields, const char *name, Range range)
{
    return fields.has_entries(name) ? fields.entries(name).number("value", range)
                                    : fields.number(name, range);
}

double number_or(const FileEntries &fields, const char *name, double otherwise, Range range)
{
    return fields.has(name) ? number(fields, name, range) : otherwise;
}

/* Pixels a side of the panel, of which there is at least one. */
uint32_t side(const FileEntries &fields, const char *name)
{
    return static_cast<uint32_t>(number(fields, name, {1.0, largest_output_side}));
}

/* Rise by run of the lenses; in both directions, but not level. */
double slope_of(const FileEntries &fields)
{
    constexpr double least = 0.01;
    const double slope = number(fields, "slope", {-1e6, 1e6});
    if (std::abs(slope) < least)
        fields.fail("slope is nearly 0: it must be at least 0.01, or at most -0.01");
    return slope;
}

/* Red, green and blue of each cell, in the order in which CellPatternMode counts them. */
void read_cells(const FileEntries &fields, LenticularSheet &sheet)
{
    constexpr size_t most_cells = 16;
    constexpr Range pixels{-16.0, 16.0};
    constexpr std::array<std::array<const char *, 2>, 3> names{
        {{"ROffsetX", "ROffsetY"}, {"GOffsetX", "GOffsetY"}, {"BOffsetX", "BOffsetY"}}};
    if (fields.is_empty_list("subpixelCells"))
        return;
    for (const FileEntries &entry : fields.list("subpixelCells", most_cells)) {
        SubpixelCell cell;
        for (size_t color = 0; color < 3; color++)
            cell[color] = {number(entry, names[color][0], pixels), number(entry, names[color][1], pixels)};
        sheet.cells.push_back(cell);
    }
    const double pattern = number_or(fields, "CellPatternMode", 0.0, {0.0, 4.0});
    sheet.pattern = static_cast<CellPattern>(static_cast<int>(pattern));
}

/* Lenses along the width and, as they lean, along the height; there cannot be more than subpixels. */
void check_lenses(const FileEntries &fields, const DisplayCalibration &calibration)
{
    const double along_width = calibration.sheet.pitch;
    const double along_height = std::abs(calibration.sheet.tilt) * along_width;
    if (along_width > 3.0 * calibration.panel.width || along_height > 3.0 * calibration.panel.height)
        fields.fail("pitch, DPI and slope say that a lens is narrower than a subpixel");
}

} // namespace

DisplayCalibration DisplayCalibration::load(const std::string &path)
{
    const FileEntries fields("The display calibration", path);
    const double slope = slope_of(fields);

    DisplayCalibration calibration{};
    calibration.panel = {side(fields, "screenW"), side(fields, "screenH")};
    const double width = calibration.panel.width, height = calibration.panel.height;
    calibration.view_cone =
        number_or(fields, "viewCone", 0.0, {0.0, largest_view_cone}) * std::numbers::pi / 180.0;
    LenticularSheet &sheet = calibration.sheet;
    sheet.flip_x = number_or(fields, "flipImageX", 0.0, flag) != 0.0;
    sheet.flip_y = number_or(fields, "flipImageY", 0.0, flag) != 0.0;
    sheet.flip_subpixels = number_or(fields, "flipSubp", 0.0, flag) != 0.0;
    sheet.invert_view = number_or(fields, "invView", 0.0, flag) != 0.0;
    sheet.center = number(fields, "center", {-1000.0, 1000.0});
    sheet.pitch = number(fields, "pitch", {0.01, 10000.0}) * width / number(fields, "DPI", {1.0, 10000.0}) *
                  std::cos(std::atan(1.0 / slope));
    sheet.tilt = height / (width * slope) * (sheet.flip_x ? -1.0 : 1.0);
    read_cells(fields, sheet);
    check_lenses(fields, calibration);
    return calibration;
}

} // namespace dff
