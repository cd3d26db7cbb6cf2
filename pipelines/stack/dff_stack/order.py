# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""In which order pictures make a sweep, nearest focus first, and what of them looks wrong."""
import hashlib

import numpy as np

from dff_stack import Unusable, listed

ORDERS = ('name', 'time', 'exif-distance')


def ordered(pictures, order):
    """Pictures come as people count their names. Those of one time or distance stay so among themselves."""
    if order == 'name':
        return list(pictures)
    what, of = {'time': ('the time at which it was taken', lambda picture: picture.time),
                'exif-distance': ('the distance that it is focused on', lambda picture: picture.distance_m)}[order]
    silent = [picture for picture in pictures if not of(picture)]
    if silent:
        raise Unusable(f'{silent[0].path} does not say {what}: --order {order} needs that of all')
    return sorted(pictures, key=of)


def direction(values):
    """1 where they mostly grow from picture to picture, -1 where they mostly fall, 0 where they tell nothing."""
    known = [value for value in values if value is not None]
    if 2 * len(known) <= len(values) or len(known) < 2:
        return 0
    steps = np.sign(np.diff(known))
    rising, falling = int((steps > 0).sum()), int((steps < 0).sum())
    if max(rising, falling) <= 2 * min(rising, falling):
        return 0
    return 1 if rising > falling else -1


def nearest_first(pictures, order, far_first, say):
    """Ordered, and turned around where the user or EXIF's focus distances say that the farthest is the first."""
    pictures = ordered(pictures, order)
    if far_first:
        return pictures[::-1]
    if direction([picture.distance_m for picture in pictures]) < 0:
        say('   The distances in EXIF fall from picture to picture: they are taken in reverse, the nearest first')
        return pictures[::-1]
    return pictures


def contradictions(pictures):
    """Names of pictures whose distance, or else whose time, does not fit the order of the others."""
    for of in (lambda picture: picture.distance_m, lambda picture: picture.time or None):
        values = [of(picture) for picture in pictures]
        if None in values:
            continue
        rises = values[0] <= values[-1]
        wrong = [picture.name for picture, before, here in zip(pictures[1:], values, values[1:])
                 if (here < before if rises else here > before)]
        if wrong:
            return wrong
    return []


def fingerprint(pixels):
    return hashlib.sha256(np.ascontiguousarray(pixels)).digest()


def duplicates(fingerprints):
    """Of each picture that has been seen before: its number and that of the first of its kind."""
    first = {}
    return [(number, first[print_]) for number, print_ in enumerate(fingerprints) if first.setdefault(print_, number) != number]


def unlikeness(thumbnails):
    """How much every two pictures differ, their brightness and contrast aside."""
    flat = np.stack([(thumbnail.ravel() - thumbnail.mean()) / max(thumbnail.std(), 1) for thumbnail in map(np.float32, thumbnails)])
    return np.abs(flat[:, None] - flat[None]).mean(2)


def out_of_place(thumbnails):
    """Numbers of pictures that interrupt a sweep: their neighbours are much more like each other than like them, and other
    neighbours are more like them."""
    if len(thumbnails) < 5:
        return []
    unlike = unlikeness(thumbnails)
    usual = np.median(np.diag(unlike, 1))
    found = []
    for z in range(1, len(thumbnails) - 1):
        here = min(unlike[z - 1, z], unlike[z, z + 1])
        elsewhere = min((max(unlike[z, k], unlike[z, k + 1]) for k in range(len(thumbnails) - 1) if z not in (k, k + 1)),
                        default=here)
        if here > max(2 * unlike[z - 1, z + 1], 2 * elsewhere, 3 * usual):
            found.append(z)
    return found


def tell_of_doubts(pictures, thumbnails, say):
    wrong = contradictions(pictures) or [pictures[z].name for z in out_of_place(thumbnails)]
    if wrong:
        say(f'   Out of order, it seems: {listed(wrong)}. See --order and --far-first')
