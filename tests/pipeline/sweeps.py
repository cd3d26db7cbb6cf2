# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Folders of pictures for tests to use."""
import base64
import pathlib
import struct
import tempfile
import unittest
import zlib

import numpy as np
import OpenImageIO as oiio

SECONDS = 200
SIDE = 96
# A JPEG of 64x64 pixels of cyan, magenta, yellow and black, in four fields, and what they are in red, green and blue.
CMYK = base64.b64decode(
    '/9j/7gAOQWRvYmUAZAAAAAAA/9sAQwAFAwQEBAMFBAQEBQUFBgcMCAcHBwcPCwsJDBEPEhIRDxERExYcFxMUGhURERghGBodHR8fHxMXIiQiHiQcHh8e/8AAFAgA'
    'QABABEMRAE0RAFkRAEsRAP/EABgAAQEBAQEAAAAAAAAAAAAAAAAJCAYE/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/aAA4EQwBNAFkASwAAPwDZbZbZbZYAAAAy4nC5'
    'YAAAAajUedSAAAAMuJwuWAAAAGo1HnUgAAADLicLlgAAABqNR51IAAAAy4nC5YAAABGd625nUgAAALMNMO4THAAAARnZncOpwAAAAsw0w7hMcAAABGdmdw6nAAAA'
    'CzDTDuExwAAAEZ2Z3DqcAAAALMNMO4THAAAAf//Z')
CMYK_COLOURS = np.array([[[255, 255, 255], [230, 138, 69]], [[0, 160, 220], [60, 60, 60]]])


def chunk(kind, data):
    """Of a PNG file."""
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def exif_saying(orientation):
    """A block of EXIF that says nothing else."""
    return b'MM\0*' + struct.pack('>IHHHIHHI', 8, 1, 0x112, 3, 1, orientation, 0, 0)


def exif_taken_at(text):
    """A block of EXIF that says when, as 2026:01:02 03:04:05: its first table says where the second is, and that where the text is."""
    first, second = struct.pack('>IHHHIII', 8, 1, 0x8769, 4, 1, 26, 0), struct.pack('>HHHIII', 1, 0x9003, 2, 20, 44, 0)
    return b'MM\0*' + first + second + text.encode() + b'\0'


def add_exif(path, block):
    """To a PNG file, before its pixels, as other programs do."""
    data = path.read_bytes()
    at = data.index(b'IDAT') - 4
    path.write_bytes(data[:at] + chunk(b'eXIf', block) + data[at:])


def write(path, pixels, orientation=1, software='camera'):
    """An array of rows, columns and channels to a picture."""
    kind = {'u1': oiio.UINT8, 'u2': oiio.UINT16, 'f4': oiio.FLOAT}[pixels.dtype.str[1:]]
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    spec['Orientation'], spec['Software'] = orientation, software
    spec['oiio:UnassociatedAlpha'] = 1
    spec['CompressionQuality'] = 100
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(pixels) and output.close(), output.geterror()
    if path.suffix == '.png':
        add_exif(path, exif_saying(orientation))


def write_pages(path, pages, description='', a_unit=0.0):
    """A TIFF file of several pages, with so many pixels in a unit."""
    specs = []
    for page in pages:
        specs.append(oiio.ImageSpec(page.shape[1], page.shape[0], page.shape[2], oiio.UINT8))
        specs[-1]['ImageDescription'] = description
        if a_unit:
            specs[-1]['XResolution'] = specs[-1]['YResolution'] = a_unit
            specs[-1]['ResolutionUnit'] = 'none'
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), tuple(specs)), output.geterror()
    for number, page in enumerate(pages):
        assert number == 0 or output.open(str(path), specs[number], 'AppendSubimage'), output.geterror()
        assert output.write_image(page), output.geterror()
    assert output.close(), output.geterror()


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
