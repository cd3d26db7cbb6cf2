# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What TIFF and BigTIFF files say that OpenImageIO does not tell: long descriptions, and that pages are missing.

A page has a table of entries, behind which stands where the next page's table is (TIFF 6.0, 2).
"""
import contextlib
import mmap
import struct

DESCRIPTION = 270
KINDS = {42: ('I', 'H', 'HHII'), 43: ('Q', 'Q', 'HHQQ')}  # of TIFF and BigTIFF: a place, how many entries, and an entry


@contextlib.contextmanager
def mapped(path):
    with open(path, 'rb') as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        yield data


def tables(data):
    """The entries, tag, type, count and value or place, of each page. Raises struct.error where the file ends before it should.
    Nothing of other files."""
    order = {b'II': '<', b'MM': '>'}.get(data[:2])
    version = struct.unpack(order + 'H', data[2:4])[0] if order else 0
    if version not in KINDS:
        return
    place_as, count_as, entry_as = (struct.Struct(order + form) for form in KINDS[version])
    place, = place_as.unpack(data[place_as.size:2 * place_as.size])
    seen = set()
    while place and place not in seen:
        seen.add(place)
        first = place + count_as.size
        count, = count_as.unpack(data[place:first])
        end = first + count * entry_as.size
        yield list(entry_as.iter_unpack(data[first:end]))
        place, = place_as.unpack(data[end:end + place_as.size])


def lacks_pages(path):
    """Whether the file ends before its last page, as one that was cut does."""
    with mapped(path) as data:
        try:
            for _ in tables(data):
                pass
        except struct.error:
            return True
    return False


def description_of(path):
    """What the first page says of the file, in full: OpenImageIO gives 65,536 bytes. Nothing of other files."""
    with mapped(path) as data:
        try:
            for tag, _, length, place in next(tables(data), ()):
                if tag == DESCRIPTION and length > 8:  # shorter ones are not where the entry says, but in it
                    return data[place:place + length].rstrip(b'\0').decode(errors='replace')
        except struct.error:  # the file ends before what it promises
            pass
    return ''
