# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""OME-TIFF: which plane each page is of, where the stage stood, and how large a pixel is (OME data model, 2016-06).

A set may have a file for each plane. Then each file describes all of them, and says which are in it by TiffData, whose UUID is the
file's own.
"""
import math
import re
import xml.etree.ElementTree

from dff_stack import Unusable, tiff

MOST_PLANES = 1000 * 1000  # more are not believed
MICROMETRES = {'nm': 1e-3, 'µm': 1.0, 'um': 1.0, 'mm': 1e3, 'cm': 1e4, 'm': 1e6}


class Ome:
    """What an OME-TIFF's first page says of all pages. Lengths in micrometres; None is not known."""

    def __init__(self, text, file_name):
        root = xml.etree.ElementTree.fromstring(text)
        pixels = next(inside(root.iter(), 'Pixels'), None)
        if pixels is None:
            raise ValueError('no pixels are described')
        self.order = pixels.get('DimensionOrder', 'XYZCT')[2:]
        self.sizes = {axis: int(pixels.get('Size' + axis, 1)) for axis in 'ZCT'}
        if min(self.sizes.values()) < 1 or self.count > MOST_PLANES or sorted(self.order) != ['C', 'T', 'Z']:
            raise ValueError(f'sizes of {self.sizes} in the order {self.order}')
        channel = next(inside(pixels, 'Channel'), pixels)
        self.sizes['C'] //= max(1, int(channel.get('SamplesPerPixel', 1)))  # red, green and blue of one page
        self.pixel_um = length(pixels, 'PhysicalSizeX', 'PhysicalSizeXUnit')
        self.step_um = length(pixels, 'PhysicalSizeZ', 'PhysicalSizeZUnit') if self.sizes['Z'] > 1 else None
        positions = {int(plane.get('TheZ')): length(plane, 'PositionZ', 'PositionZUnit')
                     for plane in inside(pixels, 'Plane') if plane.get('TheZ')}
        stands_still = len(positions) > 1 and len(set(positions.values())) == 1
        self.positions = {} if stands_still else positions  # of a stage that nobody asked
        self.planes = self.planes_of(own_data(root, pixels, file_name))

    @property
    def count(self):
        return math.prod(self.sizes.values())

    def planes_of(self, data):
        """The number of the plane, counted in the order of the dimensions, of each page."""
        planes = {}
        for element in data:
            first, stride = 0, 1
            for axis in self.order:
                first += int(element.get('First' + axis, 0)) * stride
                stride *= self.sizes[axis]
            pages = int(element.get('PlaneCount', 1 if element.get('IFD') else self.count))
            start = int(element.get('IFD', 0))
            planes.update({start + k: first + k for k in range(min(pages, self.count - first))})
        return planes

    def place_of(self, page):
        """Z, C and T of a page, or None where nothing is said of it."""
        number, place = self.planes.get(page), {}
        if number is None:
            return None
        for axis in self.order:
            number, place[axis] = divmod(number, self.sizes[axis])
        return place

    def position_um(self, z):
        if self.positions.get(z) is not None:
            return self.positions[z]
        return None if self.step_um is None else z * self.step_um


def inside(elements, name):
    return (element for element in elements if re.sub(r'^\{.*\}', '', element.tag) == name)


def length(element, name, unit_name):
    try:
        value = float(element.get(name, 'nan')) * MICROMETRES[element.get(unit_name, 'µm')]
    except (ValueError, KeyError):
        return None
    return value if math.isfinite(value) else None


def own_data(root, pixels, file_name):
    """The elements TiffData that tell of the pages of this file."""
    data = list(inside(pixels, 'TiffData'))
    if not data:
        return [xml.etree.ElementTree.Element('TiffData')]  # of all planes, in their order
    files = [next(inside(element, 'UUID'), None) for element in data]
    if len({file.text for file in files if file is not None}) <= 1:
        return data  # whatever the file is called today
    return [element for element, file in zip(data, files)
            if file is None or file.text == root.get('UUID') or file.get('FileName') == file_name]


def ome_of(picture):
    """What the file of this page says, or None where it is no OME-TIFF."""
    text = tiff.description_of(picture.path)
    if '<OME' not in text:
        return None
    try:
        return Ome(text, picture.path.name)
    except (ValueError, xml.etree.ElementTree.ParseError) as error:
        raise Unusable(f'{picture.path} says in its OME description what cannot be: {error}') from error


def place_pages(pictures, say):
    """Planes and positions of the pages of a file, which are then in the order of their planes; its pixel size in micrometres or None."""
    ome = ome_of(pictures[0])
    if ome is None:
        return pictures, None
    path, places = pictures[0].path, {page: ome.place_of(page) for page in ome.planes}
    if len({(place['C'], place['T']) for place in places.values()}) > 1:
        raise Unusable(f"{path} has {ome.sizes['C']} channels and {ome.sizes['T']} times; "
                       f'a focus sweep has one of each: save the one that is wanted by itself')
    if set(places) != {picture.page for picture in pictures}:
        say(f'   {path.name} says that it has {len(places)} planes, and has {len(pictures)}')
    for picture in pictures:
        place = places.get(picture.page)
        if place:
            picture.plane, picture.shot = place['Z'], (place['C'], place['T'])
            picture.position_um = ome.position_um(picture.plane)
    return sorted(pictures, key=lambda picture: (picture.page not in places, picture.plane)), ome.pixel_um


def check_one_shot(pictures):
    """Refuses what several channels or times of a set of files would make of one sweep."""
    first = next((picture for picture in pictures if picture.shot), None)
    for picture in pictures:
        if picture.shot and picture.shot != first.shot:
            raise Unusable(f'{picture.path} is of channel {picture.shot[0]} and time {picture.shot[1]}, and {first.path.name} of channel '
                           f'{first.shot[0]} and time {first.shot[1]}; a focus sweep has one of each: name the files of one')
