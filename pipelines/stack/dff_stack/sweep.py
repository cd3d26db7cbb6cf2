# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The pictures of a sweep: gathered, looked through once, and read again when their planes are due."""
import dataclasses
import pathlib

import numpy as np

from dff_stack import Unusable, ahead, encoding, imagej, listed, ome, order, pictures, seriation
from dff_stack.bad_pixels import BadPixels, repair

SMALL = 1000      # pixels of the longer side in which pictures are aligned, and up to twice that
SMALLEST = 500    # of the same where there is little memory
SHARE = 0.25      # of the memory that these may take
CONTACT = 160     # that a report shows
PREVIEW = 4       # times smaller


def gather(paths, chosen_order, far_first, say):
    """The pictures, nearest first, and the size of a pixel in micrometres where a file knows it."""
    found, pixel_um = [], None
    named = {pathlib.Path(path) for path in paths}
    for path in pictures.files_of(paths):
        pages = pictures.pages_of(path)
        if pages[0].is_result and path not in named:
            say(f'   {path.name} is a result of dff-stack, and left out')
            continue
        for program in (ome, imagej):
            pages, own = program.place_pages(pages, say)
            pixel_um = pixel_um or own
        found += pages
    ome.check_one_shot(found)
    if len(found) < 2:
        raise Unusable(f'{listed(paths)} holds {len(found)} picture{"s" if len(found) != 1 else ""} that can be used; '
                       f'a focus sweep has 2 or more')
    found = order.nearest_first(found, chosen_order, far_first, say)
    pictures.check_sizes(found)
    for number, picture in enumerate(found, 1):
        picture.number = number
    return found, pixel_um


@dataclasses.dataclass
class Look:
    """What a first look at all pictures told."""
    lumas: list       # small ones of 8 bits
    factor: int       # how many times smaller than the picture they are
    sharpness: list   # of each picture's parts
    white: float      # the brightest of all, of numbers with a point

    def keep_small(self):
        """Frees the memory of what alignment has been found in."""
        self.lumas = [np.round(encoding.shrunk_luma(luma[:, :, None], CONTACT)).astype(np.uint8) for luma in self.lumas]

    def leave_out(self, numbers):
        for values in (self.lumas, self.sharpness):
            values[:] = [value for number, value in enumerate(values) if number not in numbers]


class Sweep:
    """The pictures as the planes of a stack."""

    def __init__(self, found, has_deep_colour, preview):
        self.pictures = found
        self.has_deep_colour = has_deep_colour
        self.shrink = PREVIEW if preview else 1
        self.encoding, self.loss = encoding.encoding_of(found, has_deep_colour)
        self.kept = {}
        self.bad_pixels = ()

    @property
    def count(self):
        return len(self.pictures)

    @property
    def size(self):
        return self.pictures[0].width // self.shrink, self.pictures[0].height // self.shrink

    def pixels(self, picture):
        found = picture.pixels(self.encoding.read_as)
        return found if self.shrink == 1 else smaller(found, self.shrink)

    @property
    def bytes_kept(self):
        return sum(frame.nbytes for frame in self.kept.values())

    def small_side(self, memory):
        """Pixels of the longer side, and up to twice that, in which all pictures are kept for the alignment."""
        longer, whole = max(self.size), self.count * self.size[0] * self.size[1] * (4 if self.encoding.is_float else 1)
        factor = max(1, longer // SMALL)
        while whole / factor ** 2 > SHARE * memory and longer // (factor + 1) >= SMALLEST:
            factor += 1
        return longer // factor

    def read(self, number, keep=False):
        """A frame of the stack. It stays in memory if it is wanted again."""
        picture = self.pictures[number]
        frame = self.kept.pop(picture, None)
        if frame is None:
            frame = self.encoding.encode(self.pixels(picture))
        frame = repair(frame, self.bad_pixels)
        if keep:
            self.kept[picture] = frame
        return frame

    def look_through(self, keep, memory, progress):
        """Reads every picture. The first `keep` frames stay in memory, since they are wanted first."""
        small = self.small_side(memory)

        def pixels_and_luma(picture):
            pixels = self.pixels(picture)
            return pixels, encoding.shrunk_luma(pixels, small)

        look = Look([], 1, [], 1e-9)
        bad = BadPixels(self.count if self.shrink == 1 and not self.encoding.is_float else 0)
        for number, (pixels, luma) in enumerate(ahead.in_order(pixels_and_luma, self.pictures)):
            look.factor = max(1, max(pixels.shape[:2]) // small)
            bad.look_at(number, pixels, self.encoding.largest)
            if self.encoding.is_float:
                luma = np.nan_to_num(luma, posinf=0.0)
                look.white = max(look.white, finite_maximum(pixels))
                look.lumas.append(np.sqrt(np.maximum(luma, 0)))
            else:
                look.lumas.append(np.round(luma * (255 / self.encoding.largest)).astype(np.uint8))
                if number < keep:
                    self.kept[self.pictures[number]] = self.encoding.encode(pixels)
            progress.step()
        if self.encoding.is_float:
            self.encoding = dataclasses.replace(self.encoding, white=look.white)
            look.lumas = [np.round(luma * (255 / np.sqrt(look.white))).clip(0, 255).astype(np.uint8) for luma in look.lumas]
        self.bad_pixels = bad.found()
        look.sharpness = list(ahead.in_order(seriation.sharpness_of, look.lumas))
        return look

    def leave_out(self, numbers):
        for number in numbers:
            self.kept.pop(self.pictures[number], None)
        self.pictures = [picture for number, picture in enumerate(self.pictures) if number not in numbers]


def finite_maximum(pixels):
    return float(np.max(pixels, where=np.isfinite(pixels), initial=0.0))


def smaller(pixels, factor):
    """Means of squares."""
    rows, columns = pixels.shape[0] // factor, pixels.shape[1] // factor
    whole = np.ascontiguousarray(pixels[:rows * factor, :columns * factor])
    total = np.float32 if pixels.dtype.kind == 'f' else np.uint32
    sums = whole.reshape(rows, factor, -1).sum(1, dtype=total).reshape(rows, columns, factor, -1).sum(2, dtype=np.float32)
    means = sums / np.float32(factor * factor)
    return means if pixels.dtype.kind == 'f' else np.round(means).astype(pixels.dtype)


def without_duplicates(sweep, look, say):
    """Leaves out what is there twice."""
    twice = order.duplicates([order.fingerprint(luma) for luma in look.lumas])
    for number, first in twice:
        say(f'   {sweep.pictures[number].name} is the same picture as {sweep.pictures[first].name}: it is taken once')
    numbers = {number for number, _ in twice}
    if sweep.count - len(numbers) < 2:
        raise Unusable('all pictures are the same; a focus sweep has 2 or more that differ')
    sweep.leave_out(numbers)
    look.leave_out(numbers)
