# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""ImageJ's TIFF: the distance of its slices, and how large a pixel is, from the lines of its description (its FileInfo and TiffEncoder)."""
import math

from dff_stack import Unusable, tiff

MICROMETRES = {'nm': 1e-3, 'micron': 1.0, 'um': 1.0, 'µm': 1.0, r'\u00b5m': 1.0, 'mm': 1e3, 'cm': 1e4, 'm': 1e6, 'inch': 25400.0}
AXES = ('slices', 'channels', 'frames')


def place_pages(pictures, say):
    """The pages of a file, which have positions if it says how far its slices are apart; and its pixel size in micrometres or None."""
    path, said = pictures[0].path, lines_of(pictures[0])
    sizes = {axis: whole(said.get(axis)) for axis in AXES}
    if sum(size > 1 for size in sizes.values()) > 1:
        raise Unusable(f"{path} has {sizes['slices']} slices of {sizes['channels']} channels and {sizes['frames']} times; "
                       f'a focus sweep has one of each: save the one that is wanted by itself')
    images = whole(said.get('images'))
    if said and images != len(pictures):
        say(f'   {path.name} says that it has {images} planes, and has {len(pictures)}')
    of_unit = MICROMETRES.get(said.get('unit', '').lower(), math.nan)
    step_um = number(said.get('spacing')) * of_unit
    if sizes['slices'] > 1 and math.isfinite(step_um) and step_um:
        for picture in pictures:
            picture.position_um = picture.page * step_um
    a_unit = pictures[0].spec.get_float_attribute('XResolution', 0.0)  # pixels in it, whatever the file's own tag of units says
    return pictures, of_unit / a_unit if a_unit > 0 and math.isfinite(of_unit) else None


def lines_of(picture):
    text = tiff.description_of(picture.path)
    return dict(line.split('=', 1) for line in text.splitlines() if '=' in line) if text.startswith('ImageJ=') else {}


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def whole(text):
    value = number(text)
    return int(value) if 1 <= value < 1e6 else 1
