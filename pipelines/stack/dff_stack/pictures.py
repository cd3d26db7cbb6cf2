# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Pictures as files hold them, read by OpenImageIO: how large, of what kind, and their pixels, upright."""
import pathlib
import re

import numpy as np
import OpenImageIO as oiio

from dff_stack import Unusable, one_line, tiff

RAW_ENDINGS = ('.arw', '.cr2', '.cr3', '.crw', '.dng', '.nef', '.nrw', '.orf', '.pef', '.raf', '.raw', '.rw2', '.srw')
ENDINGS = ('.png', '.jpg', '.jpeg', '.tif', '.tiff', '.exr', *RAW_ENDINGS)
SMALLEST = 64  # pixels in each direction, for depth


def counting_order(path):
    """photo2 comes before photo10, and photo before both."""
    parts = re.split(r'(\d+)', path.stem.casefold())
    return [(0, int(part), '') if part.isdecimal() else (1, 0, part) for part in parts], path.suffix.casefold()


def text_of(spec, name):
    """What a file says, or nothing. Cameras and programs write letters that are not UTF-8, too."""
    try:
        return spec.get_string_attribute(name)
    except UnicodeDecodeError:
        return ''


def orientation_of(spec):
    """EXIF's 1 to 8; from 5 on rows are columns. What is none of them says nothing."""
    said = spec.get_int_attribute('Orientation', 1)
    return said if 1 <= said <= 8 else 1


class Picture:
    """One page of a file. Nothing of its pixels is kept."""

    def __init__(self, path, spec, page=0, pages=1):
        self.path, self.page, self.pages = path, page, pages
        self.spec = spec
        self.orientation = orientation_of(spec)
        self.width, self.height = (spec.height, spec.width) if self.orientation >= 5 else (spec.width, spec.height)
        self.grey = spec.nchannels <= 2  # the second is alpha
        self.bits = spec.get_int_attribute('oiio:BitsPerSample', 8 * spec.format.basesize())
        self.is_float = spec.format.basetype in (oiio.HALF, oiio.FLOAT, oiio.DOUBLE)
        self.time = text_of(spec, 'Exif:DateTimeOriginal') or text_of(spec, 'DateTime')
        if self.time:
            self.time += '.' + text_of(spec, 'Exif:SubsecTimeOriginal')
        self.distance_m = focus_distance(spec)
        self.plane = page        # in the file, of the sweep
        self.shot = None         # channel and time, where the file says so
        self.position_um = None  # along the axis, where the file says so
        self.number = None       # in the list of all, from 1

    @property
    def name(self):
        return f'{self.path.name}, page {self.page + 1}' if self.pages > 1 else self.path.name

    @property
    def size(self):
        return f'{self.width}x{self.height}'

    @property
    def is_result(self):
        """Whether it was made by this program."""
        return text_of(self.spec, 'Software').startswith('dff-stack ')

    def __str__(self):
        kind = 'half or float' if self.is_float else f'{self.bits} bits'
        return f'{self.name}  ({self.size}, {"grey" if self.grey else "colour"}, {kind})'

    def unreadable(self, error):
        return Unusable(f'{self.path} cannot be read: {one_line(error) or "its kind is not known"}'
                        + (f' (page {self.page + 1})' if self.pages > 1 else ''))

    def pixels(self, kind):
        """Rows, columns and channels, upright: 1 channel of what is grey, 3 of what is not. Alpha is left out."""
        image = open_file(self.path)
        if not image.seek_subimage(self.page, 0):
            raise self.unreadable(image.geterror())
        channels = min(image.spec().nchannels, 1 if self.grey else 3)
        read_as = {np.dtype('u1'): oiio.UINT8, np.dtype('u2'): oiio.UINT16, np.dtype('f4'): oiio.FLOAT}[np.dtype(kind)]
        pixels = image.read_image(self.page, 0, 0, channels, read_as)
        error = image.geterror()  # a file that was cut gives pixels all the same
        image.close()
        if pixels is None or error:
            raise self.unreadable(error)
        return upright(pixels, self.orientation)


def upright(pixels, orientation):
    if orientation >= 5:
        pixels = pixels.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    return pixels[::-1] if orientation in (3, 4, 7, 8) else pixels


def focus_distance(spec):
    """Metres, or None. EXIF has 0 for not known and 2^32 - 1 for infinity."""
    distance = spec.get_float_attribute('Exif:SubjectDistance', 0.0)
    return distance if 0.0 < distance < 1e6 else None


def open_file(path):
    if path.exists() and not path.is_file():  # a pipe is opened only when somebody writes into it
        raise Unusable(f'{path} cannot be read: it is not a file')
    try:
        str(path).encode()
    except UnicodeEncodeError as error:  # OpenImageIO takes no other names
        raise Unusable(f'{path} cannot be read: its name is not UTF-8; rename it') from error
    settings = oiio.ImageSpec()
    settings['oiio:UnassociatedAlpha'] = 1  # colours must not fade to black where they are transparent
    settings['raw:ColorSpace'] = 'sRGB'
    image = oiio.ImageInput.open(str(path), settings)
    if not image:
        raise Unusable(f'{path} cannot be read: {one_line(oiio.geterror()) or "its kind is not known"}')
    return image


def is_thumbnail(spec, first):
    return spec.width * 4 <= first.width and spec.height * 4 <= first.height


def pages_of(path):
    """The pictures of a file: one, or one for each page. Small previews beside the picture are no pages."""
    image = open_file(path)
    specs = [(0, oiio.ImageSpec(image.spec()))]
    while image.seek_subimage(specs[-1][0] + 1, 0):
        specs.append((specs[-1][0] + 1, oiio.ImageSpec(image.spec())))
    image.geterror()  # that there are no more pages
    image.close()
    if path.suffix.lower() in RAW_ENDINGS:
        specs = specs[:1]
    elif tiff.lacks_pages(path):
        raise Unusable(f'{path} cannot be read: it ends before its last page')
    specs = [(page, spec) for page, spec in specs if not is_thumbnail(spec, specs[0][1])]
    return [Picture(path, spec, page, len(specs)) for page, spec in specs]


def files_in(folder):
    """As people count. Hidden files are left by file managers; beside raw files cameras write JPEG pictures of the same name."""
    files = sorted((file for file in folder.iterdir() if file.suffix.lower() in ENDINGS and not file.name.startswith('.')),
                   key=counting_order)
    raw = {file.stem.casefold() for file in files if file.suffix.lower() in RAW_ENDINGS}
    return [file for file in files if file.suffix.lower() in RAW_ENDINGS or file.stem.casefold() not in raw]


def files_of(paths):
    """The files that are named, and those of the folders that are named."""
    files = []
    for path in map(pathlib.Path, paths):
        if path.is_dir():
            files += files_in(path)
        elif path.exists() or path.is_symlink():
            files.append(path)
        else:
            raise Unusable(f'{path} does not exist')
    return files


def check_sizes(pictures):
    first = pictures[0]
    for picture in pictures:
        if min(picture.width, picture.height) < SMALLEST:
            raise Unusable(f'{picture.path} is {picture.size}; pictures have at least {SMALLEST}x{SMALLEST} pixels')
        if picture.size != first.size:
            raise Unusable(f'{picture.path} is {picture.size} and {first.path.name} is {first.size}; all must have one size')
        if picture.is_float != first.is_float:
            raise Unusable(f'{picture.path} and {first.path.name} differ: one holds numbers with a point, the other whole ones')
