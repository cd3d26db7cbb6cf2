# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Pixels of the sensor that are always bright or always dark, which would pass for something sharp in every picture.

What is sharp in one picture of a sweep is not in others; a pixel that stands out from all of its neighbours in all of them is bad.
"""
import numpy as np

SAMPLES = 8     # pictures that are looked at, spread over the sweep
FEWEST = 5      # with fewer, something may be sharp in all of them
STANDS_OUT = 0.08  # of the range


def brightness_of(pixels):
    brightness = pixels[:, :, 0]
    for channel in range(1, pixels.shape[2]):
        brightness = np.maximum(brightness, pixels[:, :, channel])
    return brightness


def around(brightness, choose):
    """The greatest or the least of the eight neighbours of each pixel but those at the border; `choose` is np.maximum or np.minimum."""
    rows = choose(choose(brightness[:, :-2], brightness[:, 1:-1]), brightness[:, 2:])
    return choose(choose(rows[:-2], rows[2:]), choose(brightness[1:-1, :-2], brightness[1:-1, 2:]))


def standing_out(brightness, most):
    """Where pixels lie more than `most` above, or below, all of their neighbours: two arrays of rows and columns."""
    inner = brightness[1:-1, 1:-1]
    above, below = around(brightness, np.maximum), around(brightness, np.minimum)
    bright = (inner > above) & (inner - above > most)  # whole numbers without a sign: looked at before they are subtracted
    dark = (inner < below) & (below - inner > most)
    return np.argwhere(bright) + 1, np.argwhere(dark) + 1


class BadPixels:
    def __init__(self, count):
        """`count`: pictures of the sweep."""
        self.numbers = set(np.linspace(0, count - 1, SAMPLES).round().astype(int)) if count >= FEWEST else set()
        self.places = None  # that are bright in all pictures so far, and dark

    def look_at(self, number, pixels, largest):
        """`largest`: the greatest number that a pixel can have."""
        if number not in self.numbers:
            return
        brightness = brightness_of(pixels)
        if self.places is None:
            self.places = standing_out(brightness, STANDS_OUT * largest)
            return
        self.places = tuple(places[stand_out(brightness, places, sign, STANDS_OUT * largest)]
                            for places, sign in zip(self.places, (1, -1)))

    def found(self):
        """Rows and columns."""
        return np.concatenate(self.places) if self.places is not None else np.empty((0, 2), int)


def stand_out(brightness, places, sign, most):
    """The same of some places: which of them do."""
    rows, columns = places.T
    here = sign * brightness[rows, columns].astype(np.int64)
    others = [sign * brightness[rows + dy, columns + dx].astype(np.int64) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]
    return here - np.max(others, 0) > most


def repair(frame, places):
    """Bad pixels become the median of their neighbours."""
    height, width = frame.shape[:2]
    for row, column in places:
        around = frame[max(0, row - 1):min(height, row + 2), max(0, column - 1):min(width, column + 2)]
        frame[row, column] = np.median(around.reshape(-1, frame.shape[2]), 0).astype(frame.dtype)
    return frame
