/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/bilateral_grid.h"
#include "test_stack.h"

namespace dff::twin {

/* Bilateral solve over the occupied cells only, found through a map: (4)-(8) of Oliva-García 2022 written for
 * reading, in double precision. reference_u and reference_v may be empty with sigma_chroma = 0. */
Volume bilateral_solve(const std::vector<uint8_t> &sparse, const std::vector<uint8_t> &reference_y,
                       const std::vector<uint8_t> &reference_u, const std::vector<uint8_t> &reference_v,
                       unsigned width, unsigned height, const BilateralGrid::Parameters &parameters);

/* Where LumaGrid starts from: the mean plane of the known pixels around each cell. */
Volume spread_start(const std::vector<uint8_t> &sparse, const std::vector<uint8_t> &luma, unsigned width,
                    unsigned height, const BilateralGrid::Parameters &parameters);

struct Continued {
    Volume u;
    double residual_ratio; /* squared residuals of the starts, of the solution before to the spread one */
};

/* As LumaGrid solves: from the better of spread_start and of `last`, the solution before, whose picture had
 * the luma `last_luma`; where a cell had no pixels then, the spread one stands in. */
Continued solve_from_better_start(const std::vector<uint8_t> &sparse, const std::vector<uint8_t> &luma,
                                  const Volume &last, const std::vector<uint8_t> &last_luma,
                                  const BilateralGrid::Parameters &parameters);

} // namespace dff::twin
