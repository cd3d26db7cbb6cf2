# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A folder of pictures of one focus sweep to a picture that is sharp everywhere, and to depth."""
import ctypes

# GStreamer brings libunwind along, whose functions would take the place of half of those by which C++ throws exceptions, once
# OpenImageIO has loaded the other half: the first exception of an element would end the program.
ctypes.CDLL('libgcc_s.so.1', mode=ctypes.RTLD_GLOBAL)

VERSION = '0.1.0'
SOFTWARE = f'dff-stack {VERSION} (gst-plugins-dff)'


class Unusable(Exception):
    """Why something cannot be done, in words for the user."""


def one_line(text):
    return ' '.join(str(text).split())


def printable(text):
    """On one line, whatever bytes the names of files have in them."""
    return ''.join(letter if letter.isprintable() else letter.encode('unicode_escape').decode() for letter in str(text))


def listed(names, most=8):
    """'a, b and c', or the first few and how many there are."""
    names = [str(name) for name in names]
    if len(names) > most:
        return ', '.join(names[:most]) + f' and {len(names) - most} more'
    return ' and '.join(filter(None, [', '.join(names[:-1]), names[-1]])) if names else 'none'
