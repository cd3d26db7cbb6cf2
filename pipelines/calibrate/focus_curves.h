/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board_view.h"

#include <span>

namespace dff {

/* How a corner's edges look in the planes. Blurred by a width s, the energy of their gradient in a window of
 * the half side w is K (1 / s - 2 / (w sqrt(pi))), since the gradient of each edge is as high as it is
 * narrow, and there is none where edges cross; in plane z, s^2 = s0^2 + (c / 4)^2 with the disk's diameter c
 * = blur_step (z - vertex). */
struct FocusCurve {
    double vertex;
    double residual; /* squared, over the square of the largest energy */
};

/* The curve through the energies of a corner, one a plane, 0 where it was not seen; nothing if fewer than two
 * planes saw it, or if its vertex lies further outside the sweep than it can be continued. */
std::optional<FocusCurve> fit_curve(std::span<const double> energies, double window, double blur_step);

/* By how much the blur of these corners widens from plane to plane, in pixels. */
double find_blur_step(const std::vector<BoardView> &views);

/* Finds where each corner is sharpest, with the one blur step that a lens has for all; forgets corners in
 * planes that are blurred into their neighbours. Returns the blur step in pixels. Throws NoBoard if no corner
 * is sharp within the sweep. */
double find_focus(std::vector<BoardView> &views);

} // namespace dff
