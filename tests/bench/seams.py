#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""seams.py FOLDER DEPTH COUNT SLAB: depth beside the truth, and whether it steps where two slabs of SLAB pictures meet.

FOLDER is what photographs.py made, DEPTH a TIFF file that dff-stack --depth wrote of COUNT pictures of it, evenly spread.
"""
import pathlib
import sys

import numpy as np
import OpenImageIO as oiio

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'pipelines/stack'))
from dff_stack import slabs  # noqa: E402

BIN = 0.25     # planes of true depth, over each of which the error has one median
NEAR = 2       # planes from where two slabs meet
SHAKE = 4      # pixels by which photographs.py shifts pictures, and one more
BORDER = 60    # pixels that are left out
FEWEST = 500   # pixels of a bin


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


def main(folder, depth, count, size):
    count, depth = int(count), read(depth)
    truth = np.load(pathlib.Path(folder, 'truth.npy'))
    made = len(list(pathlib.Path(folder).glob('*.jpg')))
    inner = np.s_[BORDER:-BORDER, BORDER:-BORDER]
    truth = laid(truth * ((count - 1) / (made - 1)), depth)[inner].ravel()
    error = depth[inner].ravel() - truth
    print(f'median error {np.nanmedian(np.abs(error)):.3f} planes, {100 * np.mean(~(np.abs(error) < 1)):.2f} % more than one off or not known')
    spans = slabs.slabs_of(count, int(size))
    meet = np.array([(before[1] - 1 + after[0]) / 2 for before, after in zip(spans, spans[1:])])
    known = np.abs(error) < 3
    places, step = steps(truth[known], error[known], count)
    is_near = np.abs(places[:, None] - meet).min(1) < NEAR if len(meet) else np.zeros(len(places), bool)
    for words, which in (('where slabs meet', is_near), ('elsewhere', ~is_near)):
        if np.isfinite(step[which]).any():
            print(f'steps of depth {words}: mean {np.nanmean(step[which]):.3f} planes, greatest {np.nanmax(step[which]):.3f}')


main(*sys.argv[1:])
