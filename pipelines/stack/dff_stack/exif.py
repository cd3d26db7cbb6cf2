# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""EXIF and texts that OpenImageIO leaves out of TIFF and PNG: ISO, GPS, and in PNG all of EXIF and letters beyond ASCII.

It writes EXIF in full into JPEG files, whose block is a small TIFF file (EXIF 2.32, 4.5); a picture of a few pixels gives it to us. TIFF
takes the block's tables as its own (TIFF 6.0, 2; a table is an IFD), PNG the block as it is, in chunks before those of its
pixels, after which many do not look (PNG, third edition, 11.3.3 and 11.3.4).
"""
import pathlib
import re
import struct
import zlib

import numpy as np
import OpenImageIO as oiio

from dff_stack import scratch
from dff_stack.pictures import text_of

POINTERS = (0x8769, 0x8825)  # of a file's first table: to those of EXIF and GPS
BYTES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 6: 1, 7: 1, 8: 2, 9: 4, 10: 8, 11: 4, 12: 8}  # of a value of each type
LONG = 4
MOST_TEXT = 10000  # bytes in a JPEG file; of a block's 65,533, since the same texts in XML may be five times as long


def fit_for_jpeg(spec):
    """Leaves out the longest texts where all together are too long for a block of JPEG, at which libjpeg would end the program."""
    names = [attribute.name for attribute in spec.extra_attribs if attribute.type == oiio.TypeString]
    lengths = {name: len(text_of(spec, name).encode()) for name in names}
    while sum(lengths.values()) > MOST_TEXT:
        longest = max(lengths, key=lengths.get)
        spec.erase_attribute(re.escape(longest))
        del lengths[longest]


def block_of(spec):
    """EXIF's block of what a spec says, or nothing."""
    small = oiio.ImageSpec(spec)
    small.width = small.height = small.full_width = small.full_height = 8
    small.set_format(oiio.UINT8)
    small.erase_attribute('ICCProfile')
    fit_for_jpeg(small)
    with scratch.file() as place:
        output = oiio.ImageOutput.create('a.jpg')
        if not (output and output.open(place, small) and output.write_image(np.zeros((8, 8, small.nchannels), np.uint8))
                and output.close()):
            return b''
        data = pathlib.Path(place).read_bytes()
    start = data.find(b'Exif\0\0')
    if start < 4 or data[start - 4:start - 2] != b'\xff\xe1':
        return b''
    return data[start + 6:start - 2 + int.from_bytes(data[start - 2:start], 'big')]


def entries(data, at, order):
    """Tag, type, count and the four bytes of value or place of each entry of a table."""
    count, = struct.unpack_from(order + 'H', data, at)
    return [struct.unpack_from(order + 'HHI4s', data, at + 2 + 12 * k) for k in range(count)]


def table(found, order, following=0):
    """A table of such entries."""
    packed = b''.join(struct.pack(order + 'HHI4s', *entry) for entry in sorted(found))
    return struct.pack(order + 'H', len(found)) + packed + struct.pack(order + 'I', following)


def moved(block, at, order, to, there):
    """The table at `at` of a block, and its values, for the place `to` of a file; with the entries of the file's own that it lacks."""
    found = entries(block, at, order)
    tags = {entry[0] for entry in found}
    values, placed = b'', [entry for entry in there if entry[0] not in tags]
    after = to + 2 + 12 * (len(found) + len(placed)) + 4
    for tag, kind, count, field in found:
        size = BYTES.get(kind, 1) * count
        if size > 4:
            start, = struct.unpack(order + 'I', field)
            field = struct.pack(order + 'I', after + len(values))
            values += block[start:start + size] + bytes(size % 2)
        placed.append((tag, kind, count, field))
    return table(placed, order) + values


def complete_tiff(path, spec):
    """Gives a TIFF file, of less than 4 GiB, the tables of EXIF and GPS in full."""
    block = block_of(spec)
    with open(path, 'r+b') as file:
        header = file.read(8)
        order = {b'II*\0': '<', b'MM\0*': '>'}.get(header[:4])
        if order is None or block[:2] != header[:2]:
            return
        first, following = table_in(file, header[4:], order)
        own = {tag: table_in(file, field, order)[0] for tag, _, _, field in first if tag in POINTERS}
        of_block = entries(block, struct.unpack_from(order + 'I', block, 4)[0], order)
        places = {tag: struct.unpack(order + 'I', field)[0] for tag, _, _, field in of_block if tag in POINTERS}
        first = [entry for entry in first if entry[0] not in places]
        for tag, place in places.items():
            at = end_of(file)
            file.write(moved(block, place, order, at, own.get(tag, ())))
            first.append((tag, LONG, 1, struct.pack(order + 'I', at)))
        at = end_of(file)
        file.write(table(first, order, following))
        file.seek(4)
        file.write(struct.pack(order + 'I', at))


def table_in(file, place, order):
    """The entries of a table of a file, and where the next one is."""
    file.seek(struct.unpack(order + 'I', place)[0])
    data = file.read(2)
    data += file.read(12 * struct.unpack(order + 'H', data)[0] + 4)
    return entries(data, 0, order), struct.unpack(order + 'I', data[-4:])[0]


def end_of(file):
    """Goes there; tables begin at even places."""
    at = file.seek(0, 2)
    return at + file.write(bytes(at % 2))


def beyond_ascii(spec):
    """Names and texts of what a PNG file can say in chunks of UTF-8 alone."""
    names = [attribute.name for attribute in spec.extra_attribs if attribute.type == oiio.TypeString and attribute.name.isascii()]
    texts = {name: text_of(spec, name) for name in names}
    return {name: text for name, text in texts.items() if not text.isascii()}


PNG_NAMES = {'Artist': 'Author', 'ImageDescription': 'Description', 'DocumentName': 'Title'}


def complete_png(path, spec, texts):
    """Adds EXIF's block and texts, {name: text}, to a PNG file that lacks them."""
    block = block_of(spec)
    added = chunk(b'eXIf', block) if block else b''
    for name, text in texts.items():
        keyword = PNG_NAMES.get(name, name).encode()[:79]
        added += chunk(b'iTXt', keyword + b'\0\0\0\0\0' + text.encode(errors='replace'))
    data = pathlib.Path(path).read_bytes()
    at = 8  # of the first chunk
    while data[at + 4:at + 8] not in (b'IDAT', b''):
        at += 12 + int.from_bytes(data[at:at + 4], 'big')
    with open(path, 'wb') as file:
        file.write(data[:at] + added)
        file.write(memoryview(data)[at:])


def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
