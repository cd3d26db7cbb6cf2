#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""moving.py [--help]: what focalstackdenoise local-motion does for things that move, by the simulated camera. In `meson devenv`.

For each kind of object, noise and speed: pixels more than a plane off within 12 pixels of what moves, in per cent, and the picture there in dB
against the picture of the same sweeps without noise in which everything stood still while they were taken (lenssweeptestsrc frozen=true).
"""
import argparse
import tempfile
from pathlib import Path

import numpy as np

from elements import run

WIDTH, HEIGHT, PLANES = 640, 480, 10
FIRST = 5  # sweep that is judged: the background is known by then
AROUND = 12  # pixels
QUEUE = 'queue max-size-buffers=1000 max-size-bytes=0 max-size-time=0'


def grown(mask, by):
    """Each mask widened by so many pixels on all sides."""
    for axis in (1, 2):
        sums = np.cumsum(np.pad(mask.astype(np.int32), [(by + 1, by) if a == axis else (0, 0) for a in range(3)]), axis)
        count = mask.shape[axis]
        mask = sums.take(range(2 * by + 1, 2 * by + 1 + count), axis) - sums.take(range(count), axis) > 0
    return mask


def camera(options, where):
    """The sweeps, and their true depth and motion as raw files."""
    run(f'lenssweeptestsrc name=t near=5 far=0.5 planes={PLANES} {options} '
        f't.src ! video/x-raw,format=RGB,width={WIDTH},height={HEIGHT} ! {QUEUE} ! filesink location={where}/stacks '
        f't.depth ! {QUEUE} ! filesink location={where}/depth  t.motion ! {QUEUE} ! filesink location={where}/motion')


def computed(where, way, depth='dffdepth'):
    """Depth and picture of all sweeps: pixels of unit=index, and RGB."""
    run(f'filesrc location={where}/stacks blocksize={PLANES * HEIGHT * WIDTH * 3} ! '
        f'video/x-focal-stack,format=RGB,width={WIDTH},height={HEIGHT},planes={PLANES},framerate=26/1 ! {way} tee name=s '
        f's. ! queue ! {depth} unit=index ! tee name=d  d. ! queue ! filesink location={where}/found  s. ! queue ! c.stack  d. ! queue ! c.depth '
        f'aifcompose name=c ! filesink location={where}/picture')
    return (np.fromfile(where / 'found', '<u2').reshape(-1, HEIGHT, WIDTH),
            np.fromfile(where / 'picture', 'u1').reshape(-1, HEIGHT, WIDTH, 3))


def score(depth, picture, truth, reference, zone):
    depth, picture, reference = depth[FIRST:], picture[FIRST:], reference[FIRST:]
    off = np.abs(depth.astype(np.float64) - truth)[zone] > 65534 / (PLANES - 1)
    squares = (picture.astype(np.float64) - reference)[zone] ** 2
    return 100 * off.mean(), 10 * np.log10(255 ** 2 / max(squares.mean(), 1e-9))


def judge(options, noise, where, ways):
    camera(f'{options} frozen=true', where)
    still = computed(where, '')
    reference = still[1]
    if noise != 'none':
        camera(f'{options} noise={noise} frozen=true', where)
        still = computed(where, '')
    camera(f'{options} noise={noise}', where)
    truth = np.fromfile(where / 'depth', '<u2').reshape(-1, HEIGHT, WIDTH)[FIRST:].astype(np.float64)
    motion = np.fromfile(where / 'motion', '<u2').reshape(-1, HEIGHT, WIDTH, 4)[FIRST:]
    zone = grown((motion[..., :2] != 32768).any(-1), AROUND)
    told = [('frozen', score(*still, truth, reference, zone))]
    for name, way in ways:
        told.append((name, score(*computed(where, way), truth, reference, zone)))
    return told


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--objects', nargs='+', default=['ball', 'ball+crossing', 'turning', 'nearing', 'plain'])
    parser.add_argument('--speeds', nargs='+', type=float, default=[4.0], help='pixels a plane')
    parser.add_argument('--noise', nargs='+', default=['none', 'strong'])
    parser.add_argument('--seeds', nargs='+', type=int, default=[3])
    parser.add_argument('--blur-step', type=float, default=2.0, help='pixels a plane')
    parser.add_argument('--sweeps', type=int, default=14)
    arguments = parser.parse_args()
    ways = [('as it is', ''), ('local-motion', 'focalstackdenoise frames=16 local-motion=true !')]
    with tempfile.TemporaryDirectory() as folder:
        for objects in arguments.objects:
            for speed in arguments.speeds:
                for noise in arguments.noise:
                    for seed in arguments.seeds:
                        options = f'blur-step={arguments.blur_step} num-buffers={PLANES * arguments.sweeps} seed={seed} motion={speed} objects={objects}'
                        told = judge(options, noise, Path(folder), ways)
                        print(f'{objects} {speed:g} px a plane, noise {noise}, seed {seed}: ' +
                              ', '.join(f'{name} {off:.1f} % {dB:.1f} dB' for name, (off, dB) in told), flush=True)


if __name__ == '__main__':
    main()
