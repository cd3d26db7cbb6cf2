# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How the pictures of a sweep lie against each other: found in small ones, a window of them after the other, and kept in files.

A warp is a 3x3 matrix on pixels from the picture's centre: where a point of the middle picture is found in another one.
"""
import dataclasses
import json
import pathlib

import numpy as np

from dff_stack import Unusable

MOST_IN_WINDOW, FEWEST_IN_WINDOW = 64, 16  # pictures that are matched at once; half of them are in the next window too
MATCHED_SIDE = 1000      # pixels of the longer side at which the finest of the pictures are matched
BYTES_BESIDE = 250e6     # of the program and the elements, whatever they work on


@dataclasses.dataclass
class Alignment:
    warps: list    # a matrix for each picture, of full-size pixels
    trusted: list  # whether each was found in the pictures
    blank: list    # whether it was not because there is nothing to be matched

    def without(self, left_out):
        keep = [number for number in range(len(self.warps)) if number not in left_out]
        return Alignment(*([values[number] for number in keep] for values in (self.warps, self.trusted, self.blank)))


def unmoved(count):
    return Alignment([np.eye(3)] * count, [True] * count, [False] * count)


def normal(matrix):
    return matrix / matrix[2, 2]


def bytes_a_picture(width, height):
    """What matching needs for each of the small pictures beside themselves: the stack as it came and aligned, and what is matched."""
    finest = min(1, MATCHED_SIDE / max(width, height)) ** 2
    return width * height * (2.2 + 10 * finest)


def window_for(lumas, memory):
    """Pictures that may be matched at once in so many bytes, in which the lumas are already."""
    height, width = lumas[0].shape
    room = memory - BYTES_BESIDE - len(lumas) * width * height
    fitting = max(0, room) // bytes_a_picture(width, height)
    return int(np.clip(fitting // 2 * 2, FEWEST_IN_WINDOW, MOST_IN_WINDOW))


def windows(count, most=MOST_IN_WINDOW):
    """First and last + 1 picture of each, of which `most`, an even number, are matched at once."""
    if count <= most:
        return [(0, count)]
    step = most // 2
    pieces = -(-(count - step) // step)
    return [(first, min(first + most, count)) for first in range(0, pieces * step, step)]


def chained(found, spans):
    """The warps of all pictures against the middle one, from those of each window against the window's own middle."""
    warps = {}
    for planes, (first, _) in zip(found, spans):
        onto = np.eye(3)  # from the first window's middle picture to this one's
        shared = [number for number in range(first, first + len(planes)) if number in warps]
        if shared:
            both = [number for number in shared if planes[number - first]['trusted']] or shared
            onto = np.mean([normal(np.linalg.solve(planes[number - first]['matrix'], warps[number])) for number in both], 0)
        for number, plane in enumerate(planes, first):
            if number not in warps or number - first > len(shared) // 2:
                warps[number] = normal(plane['matrix'] @ onto)
    back = np.linalg.inv(warps[len(warps) // 2])
    return [normal(warps[number] @ back) for number in range(len(warps))]


def estimate(lumas, factor, find_warps, window=MOST_IN_WINDOW):
    """`lumas` are `factor` times smaller than the pictures; find_warps(lumas) is that of the engine."""
    spans = windows(len(lumas), window)
    found = [find_warps(lumas[first:last]) for first, last in spans]
    facts = {}
    for planes, (first, _) in zip(found, spans):
        for number, plane in enumerate(planes, first):
            before = facts.get(number, {'trusted': False, 'blank': True})
            facts[number] = {'trusted': before['trusted'] or plane['trusted'], 'blank': before['blank'] and plane['blank']}
    larger, smaller = np.diag([factor, factor, 1.0]), np.diag([1 / factor, 1 / factor, 1.0])
    return Alignment([larger @ warp @ smaller for warp in chained(found, spans)],
                     [facts[number]['trusted'] for number in range(len(lumas))],
                     [facts[number]['blank'] for number in range(len(lumas))])


def misfits(aligned):
    """Pictures that show something, which fits the others by no warp."""
    return {number for number, trusted in enumerate(aligned.trusted) if not trusted and not aligned.blank[number]}


def estimate_most(lumas, factor, find_warps, window=MOST_IN_WINDOW):
    """The same, where the picture in the middle may be the one that does not fit: nearly all others then seem not to."""
    aligned = estimate(lumas, factor, find_warps, window)
    middle = len(lumas) // 2
    if len(lumas) < 4 or 2 * len(misfits(aligned)) <= len(lumas):
        return aligned
    again = estimate(lumas[:middle] + lumas[middle + 1:], factor, find_warps, window)
    if 2 * len(misfits(again)) > len(lumas):
        return aligned
    for values, own in ((again.warps, np.eye(3)), (again.trusted, False), (again.blank, False)):
        values.insert(middle, own)
    return again


def of_part(warp, centre):
    """The same warp on pixels from another point than the picture's centre, which lies at `centre` from it."""
    to, back = np.eye(3), np.eye(3)
    to[:2, 2], back[:2, 2] = centre, -np.asarray(centre)
    return normal(back @ warp @ to)


def farthest(warps, width, height):
    """Pixels that the corner that moves most moves."""
    corners = np.array([[x * width / 2, y * height / 2, 1] for x in (-1, 1) for y in (-1, 1)]).T
    moved = [(warp @ corners) / (warp @ corners)[2] - corners for warp in warps]
    return max(float(np.abs(move).max()) for move in moved)


def text_of(warps, width, height, names=None):
    """As focalstackalign reads it, and anybody who reads JSON."""
    planes = [{'matrix': [round(float(number), 12) for number in warp.ravel()]} for warp in warps]
    for plane, name in zip(planes, names or []):
        plane['picture'] = name
    return json.dumps({'image_width': width, 'image_height': height, 'planes': planes}, indent=1) + '\n'


def load(path, width, height, count):
    """What --save-alignment wrote, for pictures of any size of the same shape."""
    try:
        facts = json.loads(pathlib.Path(path).read_text())
        size = float(facts['image_width']), float(facts['image_height'])
        warps = [normal(np.array(plane['matrix'], float).reshape(3, 3)) for plane in facts['planes']]
        if not all(np.isfinite(warp).all() and np.linalg.det(warp) > 0 for warp in warps) or min(size) <= 0:
            raise ValueError('a matrix cannot be undone')
    except (OSError, ValueError, KeyError, TypeError, AttributeError, np.linalg.LinAlgError) as error:
        raise Unusable(f'{path} is no alignment that --save-alignment wrote: {error}') from error
    if len(warps) != count:
        raise Unusable(f'{path} is an alignment of {len(warps)} pictures, and there are {count}')
    larger = np.diag([width / size[0], height / size[1], 1.0])
    return Alignment([larger @ warp @ np.linalg.inv(larger) for warp in warps], [True] * count, [False] * count)
