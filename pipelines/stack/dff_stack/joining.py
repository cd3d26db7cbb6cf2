# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Results of parts made into those of the whole, without seams: tiles side by side, slabs one behind the other."""
import numpy as np

from dff_stack import slabs
from dff_stack.engine import Solved

ROWS = 64            # that are joined at once
ONE_SURFACE = 1.0    # planes; depths that differ by more are of two surfaces, which are not to be mixed
UNTRUSTED = 0.001    # weight of what a slab says of depth beyond its ends


def empty(encoding, size):
    width, height = size
    return Solved(np.zeros((height, width, encoding.channels), encoding.kind), np.full((height, width), np.nan, np.float32),
                  np.zeros((height, width), np.uint8))


def ramp(length, is_first, margin):
    """Weights of what is pasted: 0 in its margin, 1 from BLEND pixels around the cut on."""
    if is_first:
        return np.ones(length, np.float32)
    place = np.arange(length) - (margin - slabs.BLEND / 2) + 0.5
    return np.clip(place / slabs.BLEND, 0, 1).astype(np.float32)


def mixed_depth(before, here, weight):
    """Mixed where both are of one surface, else of the heavier."""
    mix = before + weight * (here - before)
    choice = np.where((weight >= 0.5) & ~np.isnan(here) | np.isnan(before), here, before)
    return np.where(np.abs(here - before) < ONE_SURFACE, mix, choice)


def paste(whole, part, tile, margin):
    """A tile beside and below those that are there."""
    width, height = tile.size
    weight = np.minimum(ramp(width, tile.x0 == 0, margin)[None], ramp(height, tile.y0 == 0, margin)[:, None])
    for first in range(0, height, ROWS):
        rows, w = slice(first, min(first + ROWS, height)), weight[first:first + ROWS]
        there = slice(tile.y0 + rows.start, tile.y0 + rows.stop), slice(tile.x0, tile.x1)
        whole.depth[there] = mixed_depth(whole.depth[there], part.depth[rows], w)
        for of_whole, of_part, weights in ((whole.picture, part.picture, w[:, :, None]), (whole.confidence, part.confidence, w)):
            before = of_whole[there].astype(np.float32)
            of_whole[there] = np.round(before + weights * (of_part[rows] - before))


def trust_within(depth, planes, is_first, is_last):
    """How far a slab is to be believed of something at such a depth: least at its ends, beyond which there may be something sharper."""
    from_near = np.inf if is_first else depth
    from_far = np.inf if is_last else planes - 1 - depth
    return np.clip((np.minimum(from_near, from_far) + 0.25) / (slabs.OVERLAP / 2), UNTRUSTED, 1)


def weights_of(depths, spans, upper):
    """Of each slab where it says, or is said to be, so deep: near the slab that the level above names, and away from the slab's ends.
    [slab, row, column]"""
    weights = []
    for number, (first, last) in enumerate(spans):
        near = np.clip(1.5 - np.abs(upper - number), 0, None)
        trust = trust_within(depths[number] - first, last - first, number == 0, number == len(spans) - 1)
        weights.append(np.nan_to_num(near * trust))
    return np.stack(weights)


def joined_rows(depths, confidences, spans, upper):
    """Depth and confidence of some rows: of the slabs that tell of the same surface as the heaviest one, the mean.

    What is weighed is where the heaviest slab has the surface, not where each slab does: a slab that ends before it puts it at
    its own end, and would draw the mean there."""
    best = weights_of(depths, spans, upper).argmax(0)[None]
    depth = np.take_along_axis(depths, best, 0)[0]
    same = weights_of(np.broadcast_to(depth, depths.shape), spans, upper) * (np.abs(depths - depth) < ONE_SURFACE)
    total = same.sum(0)
    mean = (same * np.nan_to_num(depths)).sum(0) / np.where(total > 0, total, 1)
    return np.where(total > 0, mean, np.nan), np.take_along_axis(confidences, best, 0)[0]


def join(files, upper):
    """The slabs' depths by what the level above says of each pixel; the picture is that of the level above."""
    depth = np.empty_like(upper.depth)
    confidence = np.empty_like(upper.confidence)
    starts = np.array([first for first, _ in files.spans], np.float32)[:, None, None]
    depths, confidences = ([files.mapped(what, number) for number in range(files.count)] for what in ('depth', 'confidence'))
    for first in range(0, depth.shape[0], ROWS):
        rows = slice(first, first + ROWS)
        depth[rows], confidence[rows] = joined_rows(np.stack([one[rows] for one in depths]) + starts,
                                                    np.stack([one[rows] for one in confidences]), files.spans, upper.depth[rows])
    return Solved(upper.picture, depth, confidence)
