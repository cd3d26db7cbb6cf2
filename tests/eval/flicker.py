#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""flicker.py FOLDER...: photographs whose light is made to flicker, given to dff-stack beside those as they are.

All pictures are darkened to HEADROOM first, so that what becomes brighter does not clip, but in the last kind, in which one plane does.
Moved: per cent of textured depth that lies more than a plane elsewhere than without flicker. Mottle: by how many levels the pictures
differ in tiles, root mean square, once one gain and one offset a channel have been taken off. Of both, what is left with --even off
as well: what dffdepth makes of such light where nothing evens it, as in a live pipeline.
"""
import argparse
import pathlib
import subprocess
import tempfile

import cv2
import numpy as np

import photographs
import scores

HEADROOM = 0.7
RMS = 0.12
LEVELS = 255 * 0.05  # of an offset, root mean square


def spread(rng, *shape):
    """Numbers whose mean is 0 and whose root mean square is 1."""
    values = rng.standard_normal(shape)
    values -= values.mean(0)
    return values / values.std(0)


def flickers(seed, count):
    """What happens to plane z of `count`, a function of its number and pixels for each kind of flicker."""
    rng = np.random.default_rng(seed)
    gain, offset = 1 + RMS * spread(rng, count), LEVELS * spread(rng, count)
    colour = 1 + RMS * spread(rng, count, 3)
    clipping = np.where(np.arange(count) == count // 3, 2 / HEADROOM, 1)
    return {'gain 1 %': lambda z, picture: picture * (1 + (gain[z] - 1) / 12),
            'gain 12 %': lambda z, picture: picture * gain[z],
            'offset 5 %': lambda z, picture: picture + offset[z],
            'colours 12 %': lambda z, picture: picture * colour[z],
            'one plane clipped': lambda z, picture: picture * clipping[z]}


def pictures_in(folder, far_first):
    files = sorted(file for file in folder.iterdir() if cv2.haveImageReader(str(file)))
    return files[::-1] if far_first else files


def write(files, folder, flicker):
    """The files in the order of their names, with their flicker, of 8 bits that clip."""
    folder.mkdir()
    for z, file in enumerate(files):
        picture = flicker(z, HEADROOM * cv2.imread(str(file)))
        cv2.imwrite(str(folder / f'{z:03d}.png'), np.clip(np.rint(picture), 0, 255).astype(np.uint8))
    return folder


def stacked(folder, even):
    """Depth and picture of dff-stack, and the alignment's file."""
    depth, picture, alignment = (folder.parent / f'{folder.name}-{name}' for name in ('depth.tif', 'picture.png', 'alignment.json'))
    subprocess.run(['/usr/bin/python3', str(photographs.DFF_STACK), str(folder), '--quiet', '--even', even, '--depth', str(depth),
                    '--output', str(picture), '--save-alignment', str(alignment)], check=True, stdin=subprocess.DEVNULL)
    return cv2.imread(str(depth), cv2.IMREAD_UNCHANGED), cv2.imread(str(picture)), alignment


def textured(folder, alignment):
    """The pixels of textured tiles, by the measure of scores.real_scores."""
    planes = [scores.tenengrad(scores.luma(plane)) for plane in photographs.aligned(pictures_in(folder, False), alignment)]
    tiles = scores.textured_tiles(np.min(planes, 0), np.max(planes, 0))
    return cv2.resize(tiles.astype(np.uint8), None, fx=scores.TILE, fy=scores.TILE, interpolation=cv2.INTER_NEAREST) > 0


def moved(depth, truth, where):
    height, width = where.shape
    far = np.abs(depth - truth)[:height, :width] > 1
    return float(far[where].mean() * 100)


def mottle(picture, truth):
    """Levels, of three channels together."""
    small = [cv2.resize(each.astype(np.float32), None, fx=1 / scores.TILE, fy=1 / scores.TILE, interpolation=cv2.INTER_AREA)
             for each in (picture, truth)]
    left = []
    for channel in range(3):
        here, there = (each[..., channel].ravel() for each in small)
        left.append(there - np.polyval(np.polyfit(here, there, 1), here))
    return float(np.sqrt(np.mean(np.square(left))))


def report(folder, seed, far_first):
    files = pictures_in(folder, far_first)
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        still = write(files, scratch / 'still', lambda z, picture: picture)
        depth, picture, alignment = stacked(still, 'on')
        where = textured(still, alignment)
        for number, (kind, flicker) in enumerate(flickers(seed, len(files)).items()):
            flickering = write(files, scratch / str(number), flicker)
            found = [stacked(flickering, even) for even in ('on', 'off')]
            cells = [f'{moved(found_depth, depth, where):.2f} | {mottle(found_picture, picture):.2f}' for found_depth, found_picture, _ in found]
            print(f'| {folder.name} | {kind} | {" | ".join(cells)} |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folders', nargs='+', type=pathlib.Path, help='photographs of one sweep each, nearest first by name')
    parser.add_argument('--far-first', nargs='+', default=[], metavar='NAME', help='folders whose first picture is the farthest')
    parser.add_argument('--seed', type=int, default=1, help='of the flicker (default: %(default)s)')
    arguments = parser.parse_args()
    print('| | flicker | moved, % | mottle | moved, not evened | mottle, not evened |\n|---|---|---|---|---|---|', flush=True)
    for folder in arguments.folders:
        report(folder, arguments.seed, folder.name in arguments.far_first)


if __name__ == '__main__':
    main()
