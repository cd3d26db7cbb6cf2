# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How the numbers of pictures become those of a focal stack, and back.

Whole numbers stay what they are, of 8 or of 16 bits. Those with a point are linear light without an upper end: the stack holds
their square roots, of which 65,535 is that of the brightest of all, so that dark tones keep their steps.
"""
import dataclasses

import numpy as np

ROW_BYTES = 4  # rows of raw video begin at multiples of these


@dataclasses.dataclass(frozen=True)
class Encoding:
    format: str       # of the stack's caps
    channels: int     # samples a pixel in the stack
    kind: str         # of a sample, as numpy calls it
    is_float: bool    # what files hold
    white: float = 1.0  # the greatest number with a point

    @property
    def read_as(self):
        return 'f4' if self.is_float else self.kind

    @property
    def largest(self):
        return np.iinfo(self.kind).max

    def stride(self, width):
        """Bytes from row to row."""
        row = width * self.channels * np.dtype(self.kind).itemsize
        return -(-row // ROW_BYTES) * ROW_BYTES

    def encode(self, pixels):
        """What Picture.pixels() gave, as rows, columns and channels of the stack."""
        if self.is_float:
            light = np.clip(np.nan_to_num(pixels, nan=0.0, posinf=self.white, neginf=0.0), 0, self.white) / self.white
            pixels = np.round(np.sqrt(light) * self.largest).astype(self.kind)
        if self.channels == 1:
            return np.ascontiguousarray(pixels[:, :, :1])
        if self.channels == 3 and pixels.shape[2] == 3:
            return np.ascontiguousarray(pixels)
        frame = np.full((*pixels.shape[:2], self.channels), self.largest, self.kind)
        frame[:, :, :3] = pixels  # grey is broadcast
        return frame

    def decode(self, frame):
        """The samples of the stack as those of a file: whole numbers, or linear light as floats."""
        colours = frame[:, :, :min(self.channels, 3)]
        if not self.is_float:
            return colours
        return (colours.astype('f4') / self.largest) ** 2 * np.float32(self.white)


def encoding_of(pictures, has_deep_colour, white=1.0):
    """The encoding for all, and what of their numbers is lost, or nothing."""
    deep = any(picture.bits > 8 for picture in pictures)
    is_float = pictures[0].is_float
    if all(picture.grey for picture in pictures):
        return Encoding('GRAY16_LE' if deep else 'GRAY8', 1, '<u2' if deep else 'u1', is_float, white), None
    if deep and has_deep_colour:
        return Encoding('RGBA64_LE', 4, '<u2', is_float, white), None
    return Encoding('RGB', 3, 'u1', is_float, white), 'Stacks have 8 bits a colour: what has more is rounded' if deep else None


def shrunk_luma(pixels, longest):
    """The mean of the channels over squares, so that the longer side has `longest` pixels or up to twice that, as floats."""
    factor = max(1, max(pixels.shape[:2]) // longest)
    rows, columns, channels = pixels.shape[0] // factor, pixels.shape[1] // factor, pixels.shape[2]
    strips = np.ascontiguousarray(pixels[:rows * factor, :columns * factor]).reshape(rows, factor, columns * factor * channels)
    total = {'u1': np.uint16, 'u2': np.uint32, 'f4': np.float32}[pixels.dtype.str[1:]]  # 257 rows of 255 fit
    of_rows = strips[:, 0].astype(total)
    for k in range(1, factor):  # many times as fast as sum() with another type
        of_rows += strips[:, k]
    sums = of_rows.reshape(-1, factor * channels).astype(np.float32) @ np.ones(factor * channels, np.float32)
    return sums.reshape(rows, columns) / np.float32(factor * factor * channels)
