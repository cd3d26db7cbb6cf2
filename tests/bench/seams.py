#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""seams.py FOLDER COUNT SLAB DEPTH...: depth beside the truth, and whether it steps where two slabs of SLAB pictures meet.

FOLDER is what photographs.py made, DEPTH TIFF files that dff-stack --depth wrote of COUNT pictures of it, evenly spread: one that was
computed in slabs, and one that was computed at once, say, of which the same is told at the same places. The last lines of each are the
median error of all seams together, by how far before and behind them the surface is, and the same of the places midway between seams,
where slabs do nothing: what slabs do to depth shows there best. Single bins of little texture step anywhere; whether they do so more
at seams, the shares tell.
"""
import pathlib
import sys

import numpy as np
import OpenImageIO as oiio

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'pipelines/stack'))
from dff_stack import slabs  # noqa: E402

BIN = 0.25     # planes of true depth, over each of which the error has one median
NEAR = slabs.OVERLAP / 2 + 1  # planes from where two slabs meet, which includes the ends of both
SHAKE = 4      # pixels by which photographs.py shifts pictures, and one more
BORDER = 60    # pixels that are left out
FEWEST = 500   # pixels of a bin
QUARTER = 0.25  # planes, a step that is not to be seen more often where slabs meet than elsewhere


def read(path):
    image = oiio.ImageInput.open(str(path))
    pixels = image.read_image(0, 0, 0, 1, oiio.FLOAT)
    image.close()
    return pixels[:, :, 0]


def laid(truth, depth):
    """The truth, repeated, as the picture lies whose place the others were aligned to."""
    height, width = depth.shape
    whole = np.tile(truth, (height // truth.shape[0] + 2, width // truth.shape[1] + 2))
    shifts = [(dy, dx) for dy in range(-SHAKE, SHAKE + 1) for dx in range(-SHAKE, SHAKE + 1)]
    some = np.s_[:height:7, :width:7]
    best = min(shifts, key=lambda shift: np.nanmedian(np.abs(np.roll(whole, shift, (0, 1))[some] - depth[::7, ::7])))
    return np.roll(whole, best, (0, 1))[:height, :width]


def steps(truth, error, count):
    """Of the median error, from each bin of true depth to the next; NaN where there is too little to tell."""
    edges = np.arange(0, count, BIN)
    of_bin = np.split(error[np.argsort(truth)], np.searchsorted(np.sort(truth), edges[1:]))
    medians = np.array([np.median(part) if len(part) >= FEWEST else np.nan for part in of_bin])
    return edges[1:], np.abs(np.diff(medians))


def around(truth, error, centres, reach):
    """The median error at each half of a plane from the nearest of the centres."""
    distance = truth - centres[np.searchsorted((centres[1:] + centres[:-1]) / 2, truth)]
    places = np.arange(-reach, reach + 0.5, 0.5)
    return places, np.array([np.median(error[np.abs(distance - place) < 0.25]) for place in places])


def tell(truth, depth, count, meet):
    error = depth - truth
    print(f'median error {np.nanmedian(np.abs(error)):.3f} planes, {100 * np.mean(~(np.abs(error) < 1)):.2f} % more than one off or not known')
    known = np.abs(error) < 3
    truth, error = truth[known], error[known]
    places, step = steps(truth, error, count)
    is_near = np.abs(places[:, None] - meet).min(1) < NEAR
    for words, which in (('where slabs meet', is_near), ('elsewhere', ~is_near)):
        told = step[which & np.isfinite(step)]
        print(f'steps of depth {words}: mean {told.mean():.3f} planes, greatest {told.max():.3f}, '
              f'{100 * np.mean(told > QUARTER):.2f} % of {len(told)} above {QUARTER}')
    apart = np.floor(np.diff(meet).min())
    near, between = min(NEAR + 1, (apart - 1) / 2), (apart - slabs.OVERLAP) / 2  # from midway to where the next seam's planes begin
    for words, centres, reach in (('seams', meet, near), ('places midway between them', (meet[1:] + meet[:-1]) / 2, between)):
        places, medians = around(truth, error, centres, reach)
        print(f'around {words}:', ', '.join(f'{place:+.1f}: {value:+.3f}' for place, value in zip(places, medians)),
              f'; greatest step {np.abs(np.diff(medians)).max():.3f}')


def main(folder, count, size, *files):
    folder, count = pathlib.Path(folder), int(count)
    truth = np.load(folder / 'truth.npy') * ((count - 1) / (len(list(folder.glob('*.jpg'))) - 1))
    spans = slabs.slabs_of(count, int(size))
    meet = np.array([(before[1] - 1 + after[0]) / 2 for before, after in zip(spans, spans[1:])])
    inner = np.s_[BORDER:-BORDER, BORDER:-BORDER]
    for file in files:
        depth = read(file)
        print(file)
        tell(laid(truth, depth)[inner].ravel(), depth[inner].ravel(), count, meet)


main(*sys.argv[1:])
