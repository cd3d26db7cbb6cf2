# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Plane numbers to heights: by what files say of the stage, or by the step that the user names."""
import math
import re
import xml.etree.ElementTree

import numpy as np

from dff_stack import Unusable, exif

MICROMETRES = {'nm': 1e-3, 'µm': 1.0, 'um': 1.0, 'mm': 1e3, 'cm': 1e4, 'm': 1e6}


def has_positions(pictures):
    return all(picture.position_um is not None for picture in pictures)


def take_step(pictures, step_um):
    """Positions by the distance between two pictures, in their order."""
    for number, picture in enumerate(pictures):
        picture.position_um = number * step_um


def heights(depth, pictures):
    """Depth in micrometres, or in plane numbers where nobody knows positions; the unit; and the least and the most there can be."""
    if not has_positions(pictures):
        return depth, 'plane numbers', (0.0, len(pictures) - 1.0)
    positions = np.array([picture.position_um for picture in pictures], np.float64)
    found = np.interp(depth, np.arange(len(positions)), positions).astype(np.float32)
    found[np.isnan(depth)] = np.nan
    return found, 'micrometres', (float(positions.min()), float(positions.max()))


class Ome:
    """What an OME-TIFF's first page says of all pages. Lengths in micrometres; None is not known."""

    def __init__(self, text):
        root = xml.etree.ElementTree.fromstring(text)
        pixels = next((element for element in root.iter() if local(element) == 'Pixels'), None)
        if pixels is None:
            raise ValueError('no pixels are described')
        self.order = pixels.get('DimensionOrder', 'XYZCT')
        self.sizes = {axis: int(pixels.get('Size' + axis, 1)) for axis in 'ZCT'}
        if min(self.sizes.values()) < 1:
            raise ValueError(f'sizes of {self.sizes}')
        self.pixel_um = length(pixels, 'PhysicalSizeX', 'PhysicalSizeXUnit')
        self.step_um = length(pixels, 'PhysicalSizeZ', 'PhysicalSizeZUnit')
        self.positions = {int(plane.get('TheZ')): length(plane, 'PositionZ', 'PositionZUnit')
                          for plane in pixels if local(plane) == 'Plane' and plane.get('TheZ')}

    def z_of(self, page):
        """The plane that a page is of."""
        for axis in self.order[2:]:
            if axis == 'Z':
                return page % self.sizes['Z']
            page //= self.sizes[axis]
        return page

    def position_um(self, z):
        if self.positions.get(z) is not None:
            return self.positions[z]
        return None if self.step_um is None else z * self.step_um


def local(element):
    return re.sub(r'^\{.*\}', '', element.tag)


def length(element, name, unit_name):
    try:
        value = float(element.get(name, 'nan')) * MICROMETRES[element.get(unit_name, 'µm')]
    except (ValueError, KeyError):
        return None
    return value if math.isfinite(value) else None


def ome_of(pictures):
    """What the file of these pages says, or None where it is no OME-TIFF."""
    text = exif.description_of(pictures[0].path)
    if '<OME' not in text:
        return None
    try:
        ome = Ome(text)
    except (ValueError, xml.etree.ElementTree.ParseError) as error:
        raise Unusable(f'{pictures[0].path} says in its OME description what cannot be: {error}') from error
    if ome.sizes['C'] > 1 or ome.sizes['T'] > 1:
        raise Unusable(f"{pictures[0].path} has {ome.sizes['C']} channels and {ome.sizes['T']} times; "
                       f'a focus sweep has one of each: save the one that is wanted by itself')
    return ome


def place_pages(pictures):
    """Positions of the pages of an OME-TIFF, which are then in the order of their planes; its pixel size in micrometres or None."""
    ome = ome_of(pictures)
    if ome is None:
        return pictures, None
    for picture in pictures:
        picture.position_um = ome.position_um(ome.z_of(picture.page))
    return sorted(pictures, key=lambda picture: ome.z_of(picture.page)), ome.pixel_um
