/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/curved_field.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dff {

namespace {

constexpr float steps = DepthScale::max_pixel - 1;

DepthScale dioptre_scale(double near, double far)
{
    const double step = (far - near) / steps;
    return {DepthUnit::Dioptre, step, near - step};
}

uint16_t pixel_of(float value)
{
    return static_cast<uint16_t>(std::clamp(value + 0.5F, 1.0F, static_cast<float>(DepthScale::max_pixel)));
}

} // namespace

CurvedField::CurvedField(const FocusCalibration &focus, unsigned width, unsigned height, DepthUnit unit)
    : focus_(focus), width_(width), height_(height), near_(focus.vergences.front()),
      far_(focus.vergences.back()), scale_{DepthUnit::Millimetre, 1.0, 0.0}
{
    if (unit != DepthUnit::Dioptre && unit != DepthUnit::Millimetre)
        throw std::invalid_argument("a lens's field is in dioptres");
    float least = 0.0F, most = 0.0F;
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++) {
            const float field = field_at(static_cast<float>(x), static_cast<float>(y));
            least = std::min(least, field);
            most = std::max(most, field);
        }
    near_ += most;
    far_ += least;
    if (unit == DepthUnit::Dioptre)
        scale_ = dioptre_scale(near_, far_);
}

float CurvedField::field_at(float x, float y) const
{
    const float center_x = static_cast<float>(width_ - 1) / 2.0F,
                center_y = static_cast<float>(height_ - 1) / 2.0F;
    const float half_diagonal = std::max(std::hypot(center_x, center_y), 1.0F);
    const float right = (x - center_x) / half_diagonal, down = (y - center_y) / half_diagonal;
    return static_cast<float>(focus_.field[0]) * right + static_cast<float>(focus_.field[1]) * down +
           static_cast<float>(focus_.field[2]) * (right * right + down * down);
}

void CurvedField::to_dioptres(uint16_t *row, unsigned y) const
{
    const double first = focus_.vergences.front(), flat = focus_.vergences.front() - focus_.vergences.back();
    const auto zoom = static_cast<float>(flat / (near_ - far_));
    const auto shift = static_cast<float>((near_ - first) / (near_ - far_)) * steps;
    const auto per_dioptre = static_cast<float>(steps / (near_ - far_));
    for (unsigned x = 0; x < width_; x++) {
        const float field = field_at(static_cast<float>(x), static_cast<float>(y));
        const float pixel = 1.0F + shift + zoom * (static_cast<float>(row[x]) - 1.0F) - per_dioptre * field;
        row[x] = row[x] == DepthScale::no_value ? row[x] : pixel_of(pixel);
    }
}

void CurvedField::to_millimetres(uint16_t *row, unsigned y) const
{
    const auto first = static_cast<float>(focus_.vergences.front());
    const auto step = static_cast<float>((focus_.vergences.back() - focus_.vergences.front()) / steps);
    for (unsigned x = 0; x < width_; x++) {
        const float vergence = first + step * (static_cast<float>(row[x]) - 1.0F) +
                               field_at(static_cast<float>(x), static_cast<float>(y));
        const float millimetres =
            vergence > 0.0F ? 1000.0F / vergence : static_cast<float>(DepthScale::max_pixel);
        row[x] = row[x] == DepthScale::no_value ? row[x] : pixel_of(millimetres);
    }
}

void CurvedField::apply_to_deviations(std::byte *pixels, std::size_t stride, const std::byte *depths,
                                      std::size_t depth_stride) const
{
    const double flat = focus_.vergences.front() - focus_.vergences.back();
    const auto zoom = static_cast<float>(flat / (near_ - far_)), dioptres = static_cast<float>(flat) / steps;
    for (unsigned y = 0; y < height_; y++) {
        auto *row = reinterpret_cast<uint16_t *>(pixels + y * stride);
        const auto *depth = reinterpret_cast<const uint16_t *>(depths + y * depth_stride);
        for (unsigned x = 0; x < width_; x++) {
            const auto deviation = static_cast<float>(row[x]), distance = static_cast<float>(depth[x]);
            /* d mm = 1000 d / v^2 = mm^2 / 1000 d */
            const float bent = scale_.unit == DepthUnit::Dioptre
                                   ? zoom * deviation
                                   : dioptres * deviation * distance * distance / 1000.0F;
            row[x] = row[x] == DepthScale::no_value ? row[x] : pixel_of(bent);
        }
    }
}

void CurvedField::apply(std::byte *pixels, std::size_t stride) const
{
    for (unsigned y = 0; y < height_; y++) {
        auto *row = reinterpret_cast<uint16_t *>(pixels + y * stride);
        if (scale_.unit == DepthUnit::Dioptre)
            to_dioptres(row, y);
        else
            to_millimetres(row, y);
    }
}

} // namespace dff
