#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""time_picture.py [FILE]: makes time.jpg of time.md, picture and depth of a ball that flies by in the dark: above each sweep alone, below
with focalstackdenoise and steady=on. Run it inside `meson devenv -C build`."""
import pathlib
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'tests/eval'))
from elements import run  # noqa: E402
from moving import HEIGHT, PLANES, WIDTH, camera  # noqa: E402

SWEEPS = 12
SIZE = 288, 272  # of the part around the ball
WAYS = [('', ''), ('focalstackdenoise frames=16 local-motion=true !', 'steady=on')]


def shown(where, denoise, steady):
    """The last sweep's picture beside its depth."""
    run(f'filesrc location={where}/stacks blocksize={PLANES * HEIGHT * WIDTH * 3} ! '
        f'video/x-focal-stack,format=RGB,width={WIDTH},height={HEIGHT},planes={PLANES},framerate=26/1 ! {denoise} tee name=s '
        f's. ! queue ! dffdepth {steady} ! tee name=d  d. ! queue ! depthcolorize ! videoconvert ! video/x-raw,format=RGB ! '
        f'filesink location={where}/depth-shown  s. ! queue ! c.stack  d. ! queue ! c.depth  aifcompose name=c ! '
        f'filesink location={where}/picture')
    return np.stack([np.fromfile(where / name, 'u1').reshape(-1, HEIGHT, WIDTH, 3)[-1] for name in ('picture', 'depth-shown')])


def around_the_ball(where):
    """The part of the picture in whose middle something moves in the last sweep."""
    motion = np.fromfile(where / 'motion', '<u2').reshape(-1, HEIGHT, WIDTH, 4)[-1, ..., :2]
    middle = [int(places.mean()) for places in (motion != 32768).any(-1).nonzero()]
    top, left = (min(max(at - size // 2, 0), most - size) for at, size, most in zip(middle, SIZE[::-1], (HEIGHT, WIDTH)))
    return np.s_[:, top:top + SIZE[1], left:left + SIZE[0]]


def main(path):
    with tempfile.TemporaryDirectory() as name:
        where = pathlib.Path(name)
        camera(f'num-buffers={PLANES * SWEEPS} blur-step=2 seed=3 motion=4 noise=strong', where)
        part = around_the_ball(where)
        picture = np.vstack([np.hstack(shown(where, *way)[part]) for way in WAYS])
        np.ascontiguousarray(picture).tofile(where / 'both')
        height, width, _ = picture.shape
        run(f'filesrc location={where}/both blocksize={picture.size} ! rawvideoparse format=rgb width={width} height={height} ! '
            f'videoconvert ! jpegenc quality=75 ! filesink location={path}')


if __name__ == '__main__':
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / 'docs/time.jpg')
