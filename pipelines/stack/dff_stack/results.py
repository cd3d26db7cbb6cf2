# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Files of results: all of them, whole, or none."""
import contextlib
import os
import pathlib
import re
import shutil

import numpy as np
import OpenImageIO as oiio

from dff_stack import SOFTWARE, Unusable, exif, one_line, scratch
from dff_stack.pictures import text_of

LARGEST_HALF = 65504.0
PICTURE_ENDINGS = ('.tif', '.tiff', '.png', '.jpg', '.jpeg', '.exr')
# What describes the file that was read and not the picture in it.
OF_THE_FILE = ('oiio:.*', 'jpeg:.*', 'tiff:.*', 'png:.*', 'openexr:.*', 'raw:.*', 'compression', 'planarconfig', 'worldtocamera',
               'thumbnail.*', 'CompressionQuality', 'textureformat', 'Exif:PixelXDimension', 'Exif:PixelYDimension')


def place_of(path):
    """Where a file lies: through a link, where that leads."""
    return path.resolve() if path.is_symlink() else path.absolute()


def check_place(path):
    """Whether a file can be there."""
    folder = place_of(path).parent
    if not folder.is_dir():
        raise Unusable(f'{path} cannot be written: there is no folder {folder}')
    if path.is_dir():
        raise Unusable(f'{path} cannot be written: it is a folder')
    if not os.access(folder, os.W_OK | os.X_OK):
        raise Unusable(f'{path} cannot be written: the folder {folder} is not to be written into')


class Files:
    """Names under which results are written, and which become the real ones when all are there."""

    def __init__(self):
        self.pending = []

    def begin(self, path):
        path = pathlib.Path(path)
        check_place(path)
        path = place_of(path)
        unfinished = path.with_name(f'.{path.stem}.{os.getpid()}.unfinished{path.suffix}')
        self.pending.append((unfinished, path))
        return unfinished

    def commit(self):
        for unfinished, path in self.pending:
            os.replace(unfinished, path)
        self.pending = []

    def drop(self):
        for unfinished, _ in self.pending:
            unfinished.unlink(missing_ok=True)
        self.pending = []


@contextlib.contextmanager
def together():
    """Files that are all there afterwards, or none of them if something happens."""
    files = Files()
    try:
        yield files
        files.commit()
    finally:
        files.drop()


def kind_of(pixels):
    return {'u1': oiio.UINT8, 'u2': oiio.UINT16, 'f4': oiio.FLOAT}[pixels.dtype.str[1:]]


def encode(place, pixels, spec, name):
    """Writes pixels to a file that lies in memory, of the kind that `name`, which is what the user calls it, ends in."""
    output = oiio.ImageOutput.create('a' + name.suffix)
    if not output:
        raise Unusable(f'{name} cannot be written: {one_line(oiio.geterror())}')
    compress_quickly(spec, name)
    if not (output.open(place, spec) and output.write_image(np.ascontiguousarray(pixels)) and output.close()):
        raise Unusable(f'{name} cannot be written: {one_line(output.geterror())}')


def encoded(pixels, spec, name):
    """The bytes of a small picture."""
    with scratch.file() as place:
        encode(place, pixels, spec, pathlib.Path(name))
        return pathlib.Path(place).read_bytes()


def write(path, pixels, spec, name, complete=lambda place: None):
    """`name` is what the user calls the file; complete(place) adds what is missing in it."""
    with scratch.file() as place:
        encode(place, pixels, spec, name)
        complete(place)
        shutil.copyfile(place, path)


def compress_quickly(spec, name):
    """As small as usual to some per cent, in a fifth of the time, of which a large picture else takes most in its last step."""
    if name.suffix.lower() in ('.tif', '.tiff'):
        spec['compression'] = 'lzw' if spec.format.basetype == oiio.UINT8 else 'zip'
        spec['tiff:zipquality'] = 1
        if spec['compression'] == 'zip':  # its differences are not undone by ImageJ, nor those of floats by tifffile alone
            spec['tiff:predictor'] = 1
    elif name.suffix.lower() == '.png':
        spec['png:compressionLevel'] = 1


def say_size_of_pixel(spec, name, pixel_um):
    """In TIFF, whose readers measure by it; other files have it for printers."""
    if pixel_um and name.suffix.lower() in ('.tif', '.tiff'):
        spec['XResolution'] = spec['YResolution'] = 1e4 / pixel_um
        spec['ResolutionUnit'] = 'cm'


def plain_spec(pixels, description):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind_of(pixels))
    spec['Software'], spec['ImageDescription'] = SOFTWARE, description
    return spec


def is_empty(spec, name):
    try:
        return not spec.get_string_attribute(name)
    except UnicodeDecodeError:  # of another code, which stays as it is
        return False


def picture_spec(first, pixels, description):
    """That of the first picture, whose EXIF and profile it keeps."""
    spec = oiio.ImageSpec(first)
    for name in OF_THE_FILE:
        spec.erase_attribute(name)
    texts = [attribute.name for attribute in first.extra_attribs if attribute.type == oiio.TypeString]
    for name in texts:
        if is_empty(first, name):  # at which OpenImageIO would abort
            spec.erase_attribute(re.escape(name))
    height, width, channels = pixels.shape
    spec.x = spec.y = spec.full_x = spec.full_y = 0
    spec.width, spec.height, spec.full_width, spec.full_height = width, height, width, height
    spec.tile_width = spec.tile_height = spec.tile_depth = 0
    spec.nchannels, spec.channelnames = channels, ('R', 'G', 'B') if channels == 3 else ('Y',)
    spec.alpha_channel = spec.z_channel = -1
    spec.set_format(kind_of(pixels))
    spec['Orientation'], spec['Software'], spec['ImageDescription'] = 1, SOFTWARE, description
    spec['CompressionQuality'] = 95
    return spec


def linear_of_srgb(pixels):
    light = pixels.astype(np.float32) / np.iinfo(pixels.dtype).max
    return np.where(light <= 0.04045, light / 12.92, ((light + 0.055) / 1.055) ** 2.4).astype(np.float32)


def srgb_of_linear(light):
    light = np.clip(light, 0, 1)
    shown = np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.round(shown * 65535).astype(np.uint16)


def white_of(light):
    """The light that is shown as white: 1, or the brightest where most of a picture is above that, as of photons that were counted."""
    return np.float32(light.max() if np.median(light) > 1 else 1)


def as_file_holds(pixels, suffix):
    """EXR holds linear light, and the others whole numbers of sRGB, JPEG 8 bits of them."""
    is_float = pixels.dtype.kind == 'f'
    if suffix == '.exr':
        return pixels if is_float else linear_of_srgb(pixels)
    pixels = srgb_of_linear(pixels / white_of(pixels)) if is_float else pixels
    if suffix in ('.jpg', '.jpeg') and pixels.dtype.itemsize == 2:
        return np.round(pixels / 257).astype(np.uint8)
    return pixels


def write_picture(files, path, pixels, first, description, pixel_um=None):
    """The picture; `first` is the OpenImageIO spec of the first one of the sweep."""
    path = pathlib.Path(path)
    held = as_file_holds(pixels, path.suffix.lower())
    spec = picture_spec(first, held, description)
    if path.suffix.lower() in ('.jpg', '.jpeg'):
        exif.fit_for_jpeg(spec)
    if path.suffix.lower() == '.exr':
        spec.set_format(oiio.HALF if held.max() <= LARGEST_HALF else oiio.FLOAT)
        spec.erase_attribute('ICCProfile.*')
        spec['oiio:ColorSpace'] = 'Linear'
        taken = text_of(first, 'Exif:DateTimeOriginal')
        if taken:
            spec['DateTime'] = taken  # which EXR files have as the time of capture
    say_size_of_pixel(spec, path, pixel_um)
    write_with_facts(files.begin(path), held, spec, path)


def write_with_facts(unfinished, held, spec, path):
    """With EXIF and texts that OpenImageIO leaves out of some files."""
    facts = oiio.ImageSpec(spec)
    if path.suffix.lower() == '.png':
        texts = exif.beyond_ascii(spec)
        for name in texts:
            spec.erase_attribute(re.escape(name))
        write(unfinished, held, spec, path, lambda place: exif.complete_png(place, facts, texts))
    elif path.suffix.lower() in ('.tif', '.tiff'):
        write(unfinished, held, spec, path, lambda place: exif.complete_tiff(place, facts))
    else:
        write(unfinished, held, spec, path)


def code_of(depth, least, most):
    """16 bits: 0 = not known, else 1 for `least` to 65,535 for `most`."""
    code = 1 + np.round((depth - least) / max(most - least, 1e-9) * 65534)
    return np.nan_to_num(np.clip(code, 1, 65535)).astype(np.uint16)


def write_depth(files, path, depth, unit, extent, pixel_um):
    """TIFF and EXR hold numbers with a point of the unit, NaN = not known; PNG a code of 16 bits."""
    path = pathlib.Path(path)
    if path.suffix.lower() == '.png':
        return write_depth_code(files, path, depth, unit, extent, pixel_um)
    pixels = depth.astype(np.float32)[:, :, None]
    spec = plain_spec(pixels, f'depth in {unit}, smaller is nearer, NaN is not known')
    spec.channelnames = ('Z',) if path.suffix.lower() == '.exr' else ('Y',)
    say_size_of_pixel(spec, path, pixel_um)
    return write(files.begin(path), pixels, spec, path)


def write_depth_code(files, path, depth, unit, extent, pixel_um):
    least, most = extent
    pixels = code_of(depth, least, most)[:, :, None]
    step = (most - least) / 65534
    spec = plain_spec(pixels, f'depth in {unit} is {least:.9g} + {step:.9g} * (pixel - 1), 0 is not known')
    say_size_of_pixel(spec, pathlib.Path(path), pixel_um)
    write(files.begin(path), pixels, spec, path)


def write_colours(files, path, pixels, description):
    path = pathlib.Path(path)
    held = as_file_holds(pixels, path.suffix.lower())
    write(files.begin(path), held, plain_spec(held, description), path)


def write_numbers(files, path, numbers, description):
    """Whole numbers, of 8 bits where they fit."""
    pixels = numbers[:, :, None]
    if pixels.dtype != np.uint8:
        pixels = pixels.astype(np.uint8 if pixels.max() < 256 else np.uint16)
    write(files.begin(path), pixels, plain_spec(pixels, description), path)
