/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/light_field_geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace dff {

namespace {

glm::ivec2 view_size(const LightFieldParameters &parameters, glm::ivec2 output)
{
    switch (parameters.layout) {
    case LightFieldLayout::Quilt:
    case LightFieldLayout::Views:
        return output / glm::ivec2(parameters.columns, parameters.rows);
    default:
        return output;
    }
}

/* The middle of the picture that has this aspect. */
glm::dvec2 crop(glm::dvec2 picture, double aspect)
{
    return {std::min(picture.x, picture.y * aspect), std::min(picture.y, picture.x / aspect)};
}

double aspect_of(const LightFieldParameters &parameters, glm::dvec2 picture, glm::dvec2 view)
{
    if (parameters.layout == LightFieldLayout::Lenticular || parameters.layout == LightFieldLayout::Elemental)
        return view.x / view.y; /* the panel's pixels are square */
    return parameters.view_aspect > 0.0 ? parameters.view_aspect : picture.x / picture.y;
}

/* How many samples along x and y an eye can tell apart. A lens shows it one colour: two samples a lens are
 * what that can carry, and finer ones only alias (Zwicker et al. 2006, "Antialiasing for automultiscopic 3D
 * displays"). */
glm::dvec2 resolution(const LightFieldParameters &parameters, glm::dvec2 view)
{
    constexpr double samples = 2.0; /* of a lens */
    switch (parameters.layout) {
    case LightFieldLayout::Lenticular:
        return glm::min(view, {samples * parameters.sheet.pitch, view.y});
    case LightFieldLayout::Elemental:
        return glm::min(view, samples * view / parameters.lenses.pitch);
    default:
        return view;
    }
}

double greatest_slope(const LightFieldParameters &parameters)
{
    if (parameters.layout != LightFieldLayout::Elemental)
        return std::tan(parameters.view_cone / 2.0);
    /* From the corner of a square lens's pixels to its middle; a hexagon's is nearer. */
    return parameters.lenses.pitch * std::sqrt(0.5) / lens_gap(parameters);
}

} // namespace

LightFieldGeometry::LightFieldGeometry(const LightFieldParameters &parameters, PictureSize picture,
                                       PictureSize output)
    : view(view_size(parameters, {output.width, output.height}))
{
    const glm::dvec2 whole(picture.width, picture.height);
    const glm::dvec2 seen = crop(whole, aspect_of(parameters, whole, view));
    const glm::dvec2 shrink = glm::min(glm::dvec2(1.0), resolution(parameters, view) / seen);
    layers = glm::max(glm::ivec2(glm::round(whole * shrink)), glm::ivec2(1));

    const glm::dvec2 seen_layers = seen * glm::dvec2(layers) / whole;
    scale = seen_layers / glm::dvec2(view);
    first = 0.5 * scale + 0.5 * (glm::dvec2(layers) - seen_layers) - 0.5;
    range = parameters.depth_gain * seen_layers.x;
    lowest = range * (parameters.zero_parallax - 1.0);
    reach = greatest_slope(parameters);
}

LightFieldGeometry::Columns LightFieldGeometry::columns() const
{
    const double highest = std::max(std::abs(lowest), std::abs(lowest + range));
    const int beside = static_cast<int>(std::ceil(reach * highest)) + 2;
    const int begin = static_cast<int>(std::floor(first.x)) - beside;
    const int end = static_cast<int>(std::ceil(first.x + scale.x * view.x)) + beside;
    return {begin, end - begin + 1};
}

double view_slope(unsigned view, unsigned views, double cone)
{
    return views > 1 ? std::tan(cone * (static_cast<double>(view) / (views - 1) - 0.5)) : 0.0;
}

namespace {

int cell_of(CellPattern pattern, glm::ivec2 pixel)
{
    switch (pattern) {
    case CellPattern::Checkerboard:
        return (pixel.x + pixel.y) % 2;
    case CellPattern::Rows:
        return pixel.y % 4;
    case CellPattern::ShiftedRows:
        return (pixel.y + pixel.x % 2 * 2) % 4;
    case CellPattern::Columns:
        return pixel.x % 2;
    default:
        return 0;
    }
}

} // namespace

double subpixel_shift(const LenticularSheet &sheet, glm::ivec2 pixel, unsigned color, PictureSize panel)
{
    if (sheet.cells.empty())
        return (sheet.flip_subpixels ? 2 - color : color) / (3.0 * panel.width);
    const auto cell = static_cast<size_t>(cell_of(sheet.pattern, pixel)) % sheet.cells.size();
    const glm::dvec2 offset = sheet.cells[cell][color];
    return offset.x / panel.width + sheet.tilt * offset.y / panel.height;
}

glm::dmat2 to_lens_matrix(const LensArray &lenses)
{
    const double cosine = std::cos(lenses.rotation), sine = std::sin(lenses.rotation);
    return glm::dmat2(cosine, -sine, sine, cosine) / lenses.pitch;
}

double lens_gap(const LightFieldParameters &parameters)
{
    const LensArray &lenses = parameters.lenses;
    return lenses.gap > 0.0 ? lenses.gap : 0.5 * lenses.pitch / std::tan(parameters.view_cone / 2.0);
}

} // namespace dff
