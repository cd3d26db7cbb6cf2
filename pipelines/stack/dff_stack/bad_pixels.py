# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Pixels of the sensor that are always bright or always dark, which would pass for something sharp in every picture.

What is sharp in one picture of a sweep is not in others; a pixel that stands out from all of its neighbours in all of them is bad.
"""
import numpy as np

SAMPLES = 8     # pictures that are looked at, spread over the sweep
FEWEST = 5      # with fewer, something may be sharp in all of them
STANDS_OUT = 0.08  # of the range


def excess(brightness):
    """How far each pixel lies above the greatest, or below the least, of its eight neighbours."""
    inner = brightness[1:-1, 1:-1]
    height, width = brightness.shape
    around = [brightness[1 + dy:height - 1 + dy, 1 + dx:width - 1 + dx] for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]
    greatest, least = around[0].copy(), around[0].copy()
    for neighbour in around[1:]:
        np.maximum(greatest, neighbour, out=greatest)
        np.minimum(least, neighbour, out=least)
    found = np.zeros_like(brightness)
    found[1:-1, 1:-1] = np.where(inner > greatest, inner - greatest, np.minimum(inner - least, 0))
    return found


class BadPixels:
    def __init__(self, count):
        """`count`: pictures of the sweep."""
        self.numbers = set(np.linspace(0, count - 1, SAMPLES).round().astype(int)) if count >= FEWEST else set()
        self.above = self.below = None

    def look_at(self, number, pixels, largest):
        """`largest`: the greatest number that a pixel can have."""
        if number not in self.numbers:
            return
        brightness = np.max(pixels, 2).astype(np.float32) if pixels.shape[2] > 1 else pixels[:, :, 0].astype(np.float32)
        here = excess(brightness) / largest
        self.above = here if self.above is None else np.minimum(self.above, here)
        self.below = here.copy() if self.below is None else np.maximum(self.below, here)

    def found(self):
        """Rows and columns."""
        if self.above is None:
            return np.empty((0, 2), int)
        return np.argwhere((self.above > STANDS_OUT) | (self.below < -STANDS_OUT))


def repair(frame, places):
    """Bad pixels become the median of their neighbours."""
    height, width = frame.shape[:2]
    for row, column in places:
        around = frame[max(0, row - 1):min(height, row + 2), max(0, column - 1):min(width, column + 2)]
        frame[row, column] = np.median(around.reshape(-1, frame.shape[2]), 0).astype(frame.dtype)
    return frame
