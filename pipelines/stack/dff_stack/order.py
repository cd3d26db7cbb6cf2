# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""In which order pictures make a sweep, nearest focus first, and what of them looks wrong."""
import hashlib

import numpy as np

from dff_stack import Unusable, listed, seriation

ORDERS = ('name', 'time', 'exif-distance')
FEW_SPANS = 6           # of another order, that are not taken for two sweeps
ALMOST_THE_SAME = 0.25  # of what neighbours differ, and
HARDLY = 0.7            # of 255 in the mean, which is less than the noise of two exposures


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
    """Names of pictures whose place on the axis, or else whose distance or time, does not fit the order of the others."""
    for of in (lambda picture: picture.position_um, lambda picture: picture.distance_m, lambda picture: picture.time or None):
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


def copies(lumas):
    """Pairs of neighbours that are almost the same picture, which differ much less than either does from its other neighbour."""
    differences = [float(np.abs(a.astype(np.float32) - b).mean()) for a, b in zip(lumas, lumas[1:])]
    beside = [min(others) for others in zip([np.inf, *differences], [*differences[1:], np.inf])]
    return [number for number, here in enumerate(differences) if here < min(HARDLY, ALMOST_THE_SAME * beside[number]) and beside[number] < np.inf]


def spans_of(order):
    """First and last of each part in which pictures follow each other, forwards or backwards, as in their present order."""
    spans = []
    for number in map(int, order):
        if spans and abs(number - spans[-1][1]) == 1 and (spans[-1][0] - spans[-1][1]) * (spans[-1][1] - number) >= 0:
            spans[-1][1] = number
        else:
            spans.append([number, number])
    return spans


def spoken_spans(spans, names, most=16):
    words = [names[first] if first == last else f'{names[first]} to {names[last]}' for first, last in spans]
    return ', '.join(words[:most]) + (' and so on' if len(words) > most else '')


def doubts_of_sharpness(names, sharpness):
    """What is wrong with an order in which what is sharp does not go through the scene once, in words; or nothing."""
    other = seriation.other_order(sharpness)
    if other is None:
        return None
    spans, second = spans_of(other), seriation.two_sweeps(sharpness, other)
    so = spoken_spans(spans, names)
    if len(spans) > FEW_SPANS and second:
        return (f'The focus goes through the scene twice, it seems: from {names[0]} to {names[second - 1]} and from {names[second]} to '
                f'{names[-1]}. Name the pictures of one of the two, or all in the order in which the focus moves: {so}')
    astray = sorted(set(range(len(names))) - set(seriation.agreeing(other)))
    return (f'Out of order, it seems: {listed([names[number] for number in astray])}. What is sharp in them moves through the scene in this '
            f'order: {so}. See --order, or name the pictures so')


def tell_of_doubts(pictures, lumas, sharpness, say):
    names = [picture.name for picture in pictures]
    wrong = contradictions(pictures)
    seen = doubts_of_sharpness(names, sharpness)
    if seen:
        say(f'   {seen}')
    elif wrong:
        say(f'   Out of order, it seems, by what the files say: {listed(wrong)}. See --order and --far-first')
    for number in copies(lumas):
        say(f'   {names[number + 1]} is almost the same picture as {names[number]}: a copy, or the focus stood still')
