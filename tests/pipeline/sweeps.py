# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Folders of pictures for tests to use."""
import base64
import pathlib
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

SECONDS = 200
SIDE = 96
# A JPEG of 64x64 pixels of cyan 0, magenta 40, yellow 70 and black 10 %, which is RGB 230, 138, 69.
CMYK = base64.b64decode(
    '/9j/7gAOQWRvYmUAZAAAAAAA/9sAQwADAgIDAgIDAwMDBAMDBAUIBQUEBAUKBwcGCAwKDAwLCgsLDQ4SEA0OEQ4LCxAWEBETFBUVFQwPFxgWFBgSFBUU'
    '/8AAFAgAQABABEMRAE0RAFkRAEsRAP/EAB8AAAEFAQEBAQEBAAAAAAAAAAABAgMEBQYHCAkKC//EALUQAAIBAwMCBAMFBQQEAAABfQECAwAEEQUSITFB'
    'BhNRYQcicRQygZGhCCNCscEVUtHwJDNicoIJChYXGBkaJSYnKCkqNDU2Nzg5OkNERUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6g4SFhoeIiYqS'
    'k5SVlpeYmZqio6Slpqeoqaqys7S1tre4ubrCw8TFxsfIycrS09TV1tfY2drh4uPk5ebn6Onq8fLz9PX29/j5+v/aAA4EQwBNAFkASwAAPwD9U69Dr53r'
    '9DaKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKK'
    'KKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKK'
    'KKKKKKKKKKKKKKKKKKKKKKK//9k=')


def write(path, pixels, orientation=1, software='camera'):
    """An array of rows, columns and channels to a picture."""
    kind = {'u1': oiio.UINT8, 'u2': oiio.UINT16, 'f4': oiio.FLOAT}[pixels.dtype.str[1:]]
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    spec['Orientation'], spec['Software'] = orientation, software
    spec['oiio:UnassociatedAlpha'] = 1
    spec['CompressionQuality'] = 100
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(pixels) and output.close(), output.geterror()


def flat(value, width=SIDE, height=SIDE, kind=np.uint8):
    return np.full((height, width, 3), value, kind)


def texture(number, kind=np.uint8):
    """Sharp where the picture's number says, so that there is something to align and to measure."""
    pixels = np.random.default_rng(1).integers(60, 200, (SIDE, SIDE, 1))
    blurred = (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1) + np.roll(pixels, (1, 1), (0, 1))) // 4
    columns = np.arange(SIDE)[None, :, None] // (SIDE // 4) == number
    return (np.where(columns, pixels, blurred) * (257 if kind == np.uint16 else 1)).astype(kind)


class Folders(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.photos = pathlib.Path(folder.name, 'photos')
        self.photos.mkdir()
