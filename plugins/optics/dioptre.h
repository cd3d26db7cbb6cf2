/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <limits>

namespace dff {

/* Object vergence in dioptres of a plane `distance_mm` millimetres before the entrance pupil. Infinity is 0.
 */
constexpr double dioptre_from_millimetre(double distance_mm)
{
    return 1000.0 / distance_mm;
}

/* Distance in millimetres of a plane with the object vergence `dioptre`; infinite for 0 and below. */
constexpr double millimetre_from_dioptre(double dioptre)
{
    return dioptre > 0.0 ? 1000.0 / dioptre : std::numeric_limits<double>::infinity();
}

} // namespace dff
