# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How a stack that is too large for one computation is cut: into slabs of planes that overlap, and each into tiles."""
import dataclasses

from dff_stack import Unusable

MOST_PLANES = 64
FEWEST_PLANES = 8       # of a slab, where the memory allows it; below that tiles are made smaller instead
FEWEST_AT_ALL = 3
MOST_TILES = 64
OVERLAP = 4             # planes that two slabs share
BLEND = 64              # pixels over which two tiles are blended
MARGIN = 192            # pixels beside a tile that its depth looks at


@dataclasses.dataclass(frozen=True)
class Tile:
    """A rectangle that is computed by itself, x0 <= x < x1."""
    x0: int
    y0: int
    x1: int
    y1: int

    @property
    def size(self):
        return self.x1 - self.x0, self.y1 - self.y0

    def centre_in(self, width, height):
        """Of the tile, from that of the picture."""
        return (self.x0 + self.x1 - width) / 2, (self.y0 + self.y1 - height) / 2


@dataclasses.dataclass(frozen=True)
class Plan:
    slabs: list  # first and last + 1 plane
    tiles: list
    margin: int  # pixels that tiles reach beyond their cuts

    @property
    def is_whole(self):
        return len(self.slabs) == 1


def bytes_a_plane(encoding, pixels):
    """What a plane of a stack needs at most, in the elements and beside them."""
    sample = 1 if encoding.kind == 'u1' else 2
    frame = encoding.channels * sample
    stacks = 2 * frame                                     # as it came, and aligned
    volume = 30 * 2 / 16                                   # short numbers at a quarter of the size
    sharp = 1.5 * encoding.channels * sample + 2
    return pixels * (stacks + volume + sharp)


def bytes_beside(encoding, pixels):
    """What a computation needs however many planes it has: results, the picture being read."""
    frame = encoding.channels * (1 if encoding.kind == 'u1' else 2)
    return 600e6 + pixels * (4 * frame + 24)


def slabs_of(count, size):
    """Slabs of at most `size` planes, all about equally long, that share OVERLAP planes."""
    if count <= size:
        return [(0, count)]
    overlap = min(OVERLAP, size // 2)
    pieces = -(-(count - overlap) // (size - overlap))
    first = [round(k * (count - size) / (pieces - 1)) for k in range(pieces)]
    return [(start, start + size) for start in first]


def edges(length, pieces, margin):
    """`pieces` ranges that cover 0..length, each `margin` longer on its inner sides."""
    cuts = [round(k * length / pieces) for k in range(pieces + 1)]
    return [(max(0, a - margin), min(length, b + margin)) for a, b in zip(cuts, cuts[1:])]


def tiles_of(width, height, columns, rows, margin):
    return [Tile(x0, y0, x1, y1) for y0, y1 in edges(height, rows, margin) for x0, x1 in edges(width, columns, margin)]


def plan(count, width, height, encoding, memory, shift, most_side):
    """`shift`: pixels that planes are moved at most, which tiles must have around them. `most_side`: pixels that the elements take."""
    margin = MARGIN + BLEND // 2 + int(shift)
    columns, rows = -(-width // most_side), -(-height // most_side)
    best, best_size = None, FEWEST_AT_ALL - 1
    while columns * rows <= MOST_TILES:
        tiles = tiles_of(width, height, columns, rows, margin)
        if max(max(tile.size) for tile in tiles) <= most_side:
            size = min(MOST_PLANES, int(planes_that_fit(tiles, width * height, encoding, memory)))
            if size > best_size:
                best, best_size = tiles, size
            if size >= min(count, FEWEST_PLANES):
                break
        if width / columns >= height / rows:
            columns += 1
        else:
            rows += 1
    if best is None:
        raise Unusable(f'{memory / 2**30:.1f} GiB of memory are too few for pictures of {width}x{height}; see --memory and --preview')
    return Plan(slabs_of(count, min(best_size, count)), best, margin)


def planes_that_fit(tiles, pixels, encoding, memory):
    """`pixels`: of the whole picture, of which the planes of a slab and the results stay in memory while tiles are computed."""
    of_tile = max(tile.size[0] * tile.size[1] for tile in tiles)
    frame = encoding.channels * (1 if encoding.kind == 'u1' else 2)
    whole = 0 if len(tiles) == 1 else pixels
    room = memory - bytes_beside(encoding, of_tile) - whole * (frame + 5)
    return max(0, room // (bytes_a_plane(encoding, of_tile) + whole * frame))
