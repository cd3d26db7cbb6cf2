# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Plane numbers to heights: by what files say of the stage, or by the step that the user names."""
import itertools

import numpy as np


def has_positions(pictures):
    """Whether they are known, and of a stage that moved."""
    positions = {picture.position_um for picture in pictures}
    return None not in positions and len(positions) > 1


def take_step(pictures, step_um):
    """Positions by the distance between two pictures, in their order. The stage has moved for a page that is left out, too."""
    pictures[0].position_um = 0.0
    for before, here in itertools.pairwise(pictures):
        steps = abs(here.plane - before.plane) if here.path == before.path else 1
        here.position_um = before.position_um + steps * step_um


def heights(depth, pictures):
    """Depth in micrometres, or in plane numbers where nobody knows positions; the unit; and the least and the most there can be."""
    if not has_positions(pictures):
        return depth, 'plane numbers', (0.0, len(pictures) - 1.0)
    positions = np.array([picture.position_um for picture in pictures], np.float64)
    found = np.interp(depth, np.arange(len(positions)), positions).astype(np.float32)
    found[np.isnan(depth)] = np.nan
    return found, 'micrometres', (float(positions.min()), float(positions.max()))
