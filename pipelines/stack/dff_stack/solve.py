# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A stack of any number of planes to depth and picture: slab by slab, tile by tile, and the slabs' pictures in the same way again."""
import dataclasses
import pathlib
import tempfile

import numpy as np

from dff_stack import Unusable, ahead, alignment, engine, joining, slabs


@dataclasses.dataclass
class Work:
    """What all levels of a computation share."""
    memory: float         # bytes
    even: bool            # brightness
    progress: object
    tell: object          # called with a warning of an element
    prefer: str = 'clearest'  # of dffdepth: near or far where one is seen through the other
    scratch: str | None = None  # folder for what does not fit into memory


class SlabFiles:
    """The pictures of slabs as the planes of a stack one level up, and their depth. They lie in files."""

    def __init__(self, folder, encoding, size):
        self.folder, self.encoding, self.size = pathlib.Path(folder), encoding, size
        self.spans = []

    @property
    def count(self):
        return len(self.spans)

    def add(self, span, solved):
        try:
            for what in ('picture', 'depth', 'confidence'):
                np.save(self.file(what, self.count), getattr(solved, what))
        except OSError as error:
            raise Unusable(f'{self.folder} cannot hold what waits for its turn ({error}): TMPDIR names another folder') from error
        self.spans.append(span)

    def file(self, what, number):
        return self.folder / f'{what}-{number}.npy'

    def mapped(self, what, number):
        return np.load(self.file(what, number), mmap_mode='r')

    def read(self, number, keep=False):
        return self.mapped('picture', number)


def solve_part(frames, warps, work, encoding, size):
    """One run of the elements."""
    with tempfile.TemporaryDirectory(prefix='dff-stack-') as folder:
        calibration = None
        if warps is not None:
            calibration = pathlib.Path(folder, 'alignment.json')
            calibration.write_text(alignment.text_of(warps, *size))
        return engine.solve(frames, len(frames), encoding, size, calibration, work)


class Frames:
    """Some planes of a source, read when they are asked for; cut to a tile."""

    def __init__(self, source, numbers, kept, progress):
        self.source, self.numbers, self.kept, self.progress = source, numbers, kept, progress

    def __len__(self):
        return len(self.numbers)

    def __iter__(self):
        for frame in ahead.in_order(lambda number: self.source.read(number, number in self.kept), self.numbers):
            yield frame
            self.progress.step()


def solve_slab(source, span, kept, warps, plan, work):
    """The planes of a slab, in one piece or in tiles; `kept` planes are wanted again later."""
    numbers = range(*span)
    own = warps and [warps[number] for number in numbers]
    frames = Frames(source, numbers, kept, work.progress)
    if len(plan.tiles) == 1:
        return solve_part(frames, own, work, source.encoding, source.size)
    frames = list(frames)
    whole = joining.empty(source.encoding, source.size)
    for tile in plan.tiles:
        part = [frame[tile.y0:tile.y1, tile.x0:tile.x1] for frame in frames]
        centre = tile.centre_in(*source.size)
        solved = solve_part(part, own and [alignment.of_part(warp, centre) for warp in own], work, source.encoding, tile.size)
        joining.paste(whole, solved, tile, plan.margin)
    return whole


def plan_of(source, warps, work):
    shift = alignment.farthest(warps, *source.size) if warps else 0
    return slabs.plan(source.count, *source.size, source.encoding, work.memory, shift, engine.most_side())


def solve(source, warps, work, level=1):
    """`source` has count, size, encoding and read(number, keep); `warps` is None where the planes lie as they should."""
    plan = plan_of(source, warps, work)
    words = 'Computing' if level == 1 else 'Joining'
    if plan.is_whole:
        work.progress.begin(f'{words}: {source.count} {"pictures" if level == 1 else "slabs"}', source.count)
        return solve_slab(source, plan.slabs[0], (), warps, plan, work)
    work.progress.begin(f'{words}: {source.count} {"pictures" if level == 1 else "slabs"} in {len(plan.slabs)} slabs',
                        sum(last - first for first, last in plan.slabs))
    with tempfile.TemporaryDirectory(prefix='dff-stack-', dir=work.scratch) as folder:
        files = SlabFiles(folder, source.encoding, source.size)
        for number, span in enumerate(plan.slabs):
            kept = range(*plan.slabs[number + 1]) if number + 1 < len(plan.slabs) else ()
            files.add(span, solve_slab(source, span, kept, warps, plan, work))
        still = [np.eye(3)] * files.count if work.even else None
        quiet = dataclasses.replace(work, tell=lambda text: None)  # slabs may be equally sharp everywhere
        upper = solve(files, still, quiet, level + 1)
        return joining.join(files, upper)
