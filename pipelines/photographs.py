#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""photographs.py FOLDER FRAMES: the photographs of a folder, as frames that GStreamer need not decode.

Takes PNG, JPEG and TIFF together, in the order in which people count, turned upright, and writes one raw frame each to
FRAMES/00, FRAMES/01 and so on, and their caps to FRAMES/caps. Grey pictures stay grey, of 16 bits if one of them has more than 8;
all others become RGB of 8 bits. Says on stdout what it takes in which order. A picture that cannot be used ends it: the last line
on stderr names the file and the reason.
"""
import pathlib
import re
import sys

import numpy as np
import OpenImageIO as oiio

ENDINGS = ('.png', '.jpg', '.jpeg', '.tif', '.tiff')
FEWEST, MOST = 2, 64         # planes of a stack
SMALLEST, LARGEST = 64, 8192  # pixels in each direction
ROW_BYTES = 4                # rows of raw video begin at multiples of these


class Unusable(Exception):
    """Why the photographs cannot be used."""


def counting_order(path):
    """photo2 comes before photo10."""
    return [int(part) if part.isdecimal() else part for part in re.split(r'(\d+)', path.name.casefold())]


def pictures_of(folder):
    paths = [path for path in folder.iterdir() if path.suffix.lower() in ENDINGS and not path.name.startswith('.')]
    if not FEWEST <= len(paths) <= MOST:
        raise Unusable(f'{folder} holds {len(paths)} PNG, JPEG or TIFF pictures; a focus sweep has {FEWEST} to {MOST}')
    return sorted(paths, key=counting_order)


class Photograph:
    """A picture of one page."""

    def __init__(self, path):
        self.path = path
        picture = self.open()
        spec = picture.spec()
        if picture.seek_subimage(1, 0):
            raise Unusable(f'{path} has several pages; each picture must be a file of its own')
        self.orientation = spec.get_int_attribute('Orientation', 1)  # EXIF's 1 to 8; from 5 on rows are columns
        self.width, self.height = (spec.height, spec.width) if self.orientation >= 5 else (spec.width, spec.height)
        self.grey = spec.nchannels <= 2  # the second is alpha
        self.bits = spec.get_int_attribute('oiio:BitsPerSample', 8 * spec.format.basesize())

    def open(self):
        as_stored = oiio.ImageSpec()
        as_stored['oiio:UnassociatedAlpha'] = 1  # colours must not fade to black where they are transparent
        picture = oiio.ImageInput.open(str(self.path), as_stored)
        if not picture:
            raise Unusable(f'{self.path} cannot be read: {one_line(oiio.geterror())}')
        return picture

    def pixels(self, kind):
        """Rows, columns and channels, upright."""
        picture = self.open()
        pixels = picture.read_image(0, 0, 0, picture.spec().nchannels, oiio.UINT16 if kind == np.uint16 else oiio.UINT8)
        error = picture.geterror()  # a file that was cut gives pixels all the same
        if pixels is None or error:
            raise Unusable(f'{self.path} cannot be read: {one_line(error)}')
        if self.orientation >= 5:
            pixels = pixels.swapaxes(0, 1)
        if self.orientation in (2, 3, 6, 7):
            pixels = pixels[:, ::-1]
        return pixels[::-1] if self.orientation in (3, 4, 7, 8) else pixels

    @property
    def size(self):
        return f'{self.width}x{self.height}'

    def __str__(self):
        return f'{self.path.name}  ({self.size}, {"grey" if self.grey else "colour"}, {self.bits} bits)'


def one_line(error):
    return ' '.join(error.split()) or 'its kind is not known'


def check(photographs):
    first = photographs[0]
    for photograph in photographs:
        if not all(SMALLEST <= side <= LARGEST for side in (photograph.width, photograph.height)):
            raise Unusable(f'{photograph.path} is {photograph.size}; pictures have {SMALLEST}x{SMALLEST} to '
                           f'{LARGEST}x{LARGEST} pixels')
        if photograph.size != first.size:
            raise Unusable(f'{photograph.path} is {photograph.size} and {first.path.name} is {first.size}; all must have one size')


def format_of(photographs):
    """The name of the format of all, its channels, and its kind of number."""
    deep = any(photograph.bits > 8 for photograph in photographs)
    if not all(photograph.grey for photograph in photographs):
        if deep:
            print('   Stacks have 8 bits a colour: what has more is rounded')
        return 'RGB', 3, np.uint8
    return ('GRAY16_LE', 1, np.uint16) if deep else ('GRAY8', 1, np.uint8)


def frame(photograph, channels, kind):
    """The picture as a frame of raw video."""
    pixels = photograph.pixels(kind)
    if pixels.shape[2] < channels:
        pixels = np.repeat(pixels[:, :, :1], channels, axis=2)
    rows = np.ascontiguousarray(pixels[:, :, :channels], np.dtype(kind).newbyteorder('<'))
    rows = rows.view(np.uint8).reshape(photograph.height, -1)
    return np.pad(rows, ((0, 0), (0, -rows.shape[1] % ROW_BYTES))).tobytes()


def main(folder, frames):
    photographs = [Photograph(path) for path in pictures_of(pathlib.Path(folder))]
    check(photographs)
    for number, photograph in enumerate(photographs, 1):
        print(f'   {number:2}  {photograph}', flush=True)
    name, channels, kind = format_of(photographs)
    for number, photograph in enumerate(photographs):
        pathlib.Path(frames, f'{number:02}').write_bytes(frame(photograph, channels, kind))
    pathlib.Path(frames, 'caps').write_text(f'video/x-raw,format={name},width={photographs[0].width},height={photographs[0].height}\n')


if __name__ == '__main__':
    sys.stdout.reconfigure(errors='backslashreplace')  # names may hold any bytes
    try:
        main(*sys.argv[1:])
    except (Unusable, OSError, UnicodeError) as error:
        sys.exit(str(error))
