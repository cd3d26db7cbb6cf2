# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""In which order pictures follow each other as those of a sweep do, by what is sharp in them.

While the focus goes through a scene, each part of it becomes sharp once: its sharpness rises from nothing to its best and falls to
nothing again, and changes by twice its best in all. In a wrong order it changes by more. How much all parts change from picture to
picture is a distance, and the right order the shortest way through all pictures, from nothing to nothing. What an order's way
is longer than it need be is its detour, as a part of that.

The way is changed for as long as one change makes it shorter (2-opt, Croes 1958, and insertions), beginning with the given order and
with that of the Fiedler vector (Atkins, Boman and Hendrickson 1998).
"""
import numpy as np

PARTS = 24        # of the longer side of a picture
FEWEST_PIXELS = 8  # of the side of a part
CLEAR = 0.03      # that another order must save; photographs in their order come to less than 0.01, strong noise to 0.015
LARGE_PART = 1 / 3  # of the detour, that another order must save, or some picture must be astray by more than
SHORT_WAY = 0.1    # of the sweep: in a fine long one shake alone takes pictures so far, and saves up to a quarter of its detour
SHARPER = 2        # times as sharp as where it is least so becomes some part in any sweep; noise alone makes it 1.1 to 1.6 times so
LEAST = 0.01      # that a change of the given order must save, so that noise does not change it
NOTHING = 1e-9    # more than rounding saves
FEWEST_PICTURES = 4  # of one of two sweeps
TWICE = 0.15      # of what another order saves, that two sweeps may lack


def sharpness_of(luma):
    """Of each part of a picture: the root of the mean square of its steps, as a part of the picture's brightness."""
    height, width = luma.shape
    side = max(FEWEST_PIXELS, max(width, height) // PARTS)
    rows, columns = (height - 1) // side, (width - 1) // side
    here = luma[:rows * side + 1, :columns * side + 1].astype(np.float32)
    steps = np.diff(here, axis=1)[:-1] ** 2 + np.diff(here, axis=0)[:, :-1] ** 2
    means = steps.reshape(rows, side, columns, side).mean((1, 3))
    return np.sqrt(means).ravel() / max(float(luma.mean()), 1)


def distances(sharpness):
    """Between every two pictures, and of each from nothing, which is number 0. The way there and back of a part that is sharp in
    one picture only adds up to its share of 1."""
    risen = sharpness - sharpness.min(0)
    points = np.vstack([np.zeros(risen.shape[1]), risen])
    return np.stack([np.abs(points - point).sum(1) for point in points]) / max(2 * risen.max(0).sum(), 1e-9)


def detour(away, order):
    way = np.concatenate([[0], np.asarray(order) + 1, [0]])
    return away[way[:-1], way[1:]].sum() - 1


def best_reversal(away, way):
    """What the best reversal of a part of a round way saves, and the way then."""
    after = np.roll(way, -1)
    edges = away[way, after]
    saved = np.triu(edges[:, None] + edges - away[way[:, None], way] - away[after[:, None], after], 2)
    first, last = np.unravel_index(saved.argmax(), saved.shape)
    turned = way.copy()
    turned[first + 1:last + 1] = way[first + 1:last + 1][::-1]
    return saved[first, last], turned


def best_insertion(away, way):
    """The same of taking one picture out and putting it elsewhere."""
    before, after = np.roll(way, 1), np.roll(way, -1)
    edges = away[way, after]
    without = away[before, way] + edges - away[before, after]
    saved = without[:, None] - (away[way[:, None], way] + away[way[:, None], after] - edges)
    own = np.arange(len(way))
    saved[own, own] = saved[own, own - 1] = 0
    taken, there = np.unravel_index(saved.argmax(), saved.shape)
    moved = np.insert(np.delete(way, taken), there + (there < taken), way[taken])
    return saved[taken, there], moved


def shortened(away, order, least):
    """An order that no change makes shorter by more than `least`."""
    way = np.concatenate([[0], np.asarray(order) + 1])
    while True:
        saved, changed = max(best_reversal(away, way), best_insertion(away, way), key=lambda found: found[0])
        if not saved > least:
            return np.roll(way, -int(np.flatnonzero(way == 0)[0]))[1:] - 1
        way = changed


def by_likeness(away):
    """By the Fiedler vector of how alike the pictures are."""
    between = away[1:, 1:]
    alike = np.exp(-(2 * between / max(float(np.median(between)), 1e-9)) ** 2)
    return np.argsort(np.linalg.eigh(np.diag(alike.sum(1)) - alike)[1][:, 1])


def agreeing(order):
    """Members of the longest part of an order that grows, from the first to the last."""
    longest, before = np.ones(len(order), int), np.full(len(order), -1)
    for here in range(1, len(order)):
        fits = np.where(order[:here] < order[here], longest[:here], 0)
        if fits.max() > 0:
            before[here] = fits.argmax()
            longest[here] = fits.max() + 1
    found, at = [], int(longest.argmax())
    while at >= 0:
        found.append(int(order[at]))
        at = before[at]
    return found[::-1]


def other_order(sharpness):
    """The order in which what is sharp goes through the scene once, as numbers of pictures; None where it is the one they have.
    `sharpness`: pictures, parts."""
    count = len(sharpness)
    if count < 3:
        return None
    sharpness = np.asarray(sharpness, np.float64)
    if (sharpness.max(0) < SHARPER * sharpness.min(0)).all():
        return None
    away = distances(sharpness)
    given = np.arange(count)
    if detour(away, given) <= CLEAR:
        return None
    found = shortened(away, given, LEAST)
    other = shortened(away, by_likeness(away), NOTHING)
    if detour(away, other) < detour(away, found) - CLEAR:
        found = other
    saved = detour(away, given) - detour(away, found)
    if saved < CLEAR:
        return None
    if len(agreeing(found)) < len(agreeing(found[::-1])):
        found = found[::-1]
    if saved < LARGE_PART * detour(away, given) and np.abs(found - given).max() <= SHORT_WAY * count:
        return None
    return found


def two_sweeps(sharpness, other):
    """The first picture of the second sweep where the pictures are two sweeps, one after the other, rather than one that has got
    out of order, or None. `other`: the order in which there is one sweep."""
    risen = np.asarray(sharpness, np.float64) - np.min(sharpness, 0)
    fewest = max(FEWEST_PICTURES, len(risen) // 4)
    given, least = detour_of(risen), detour_of(risen[other])
    both = {first: detour_of(risen[:first]) + detour_of(risen[first:]) for first in range(fewest, len(risen) - fewest + 1)}
    place = min(both, key=both.get, default=None)
    return place if both and both[place] - least < TWICE * (given - least) else None


def detour_of(risen):
    """Of pictures in their order, not as a part of anything."""
    closed = np.pad(risen, ((1, 1), (0, 0)))
    return np.abs(np.diff(closed, axis=0)).sum() - 2 * risen.max(0).sum()
