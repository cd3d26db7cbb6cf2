#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""side_by_side.py DATA SCENE OUT.jpg --at X Y: one part of a scene's all-in-focus pictures at 100 %, ours and those of the programs
of peers.py that are installed, all of the same aligned planes."""
import argparse
import pathlib
import tempfile

import cv2
import numpy as np

import elements
import peers
from evaluate import Conditions, scenes_in

TITLE = 24  # pixels above each part


def titled(part, title):
    bar = np.full((TITLE, part.shape[1], 3), 255, np.uint8)
    cv2.putText(bar, title, (4, TITLE - 7), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 1, cv2.LINE_AA)
    return np.vstack([bar, part])


def pictures_of(scene, folder):
    """Each picture and what made it; all of the planes that the first run aligned."""
    for blend in ('linear', 'sharp'):
        result = elements.compute(scene, Conditions('', 'none', 0, 2, blend), folder / blend)
        yield f'blend={blend}', result.picture
    files = folder / 'planes'
    files.mkdir()
    for z, plane in enumerate(result.stack):
        cv2.imwrite(str(files / f'{z:02d}.png'), plane)
    for name in peers.installed():
        yield name, peers.make_picture(name, files, folder / f'{name}.png')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('data', type=pathlib.Path, help='folder of scenes')
    parser.add_argument('scene', help='name of a folder of photographs in it')
    parser.add_argument('out', type=pathlib.Path, help='the picture to write')
    parser.add_argument('--at', nargs=2, type=int, required=True, metavar=('X', 'Y'), help='left upper corner of the part')
    parser.add_argument('--size', nargs=2, type=int, default=(360, 360), metavar=('WIDTH', 'HEIGHT'), help='default: 360 360')
    parser.add_argument('--farthest-first', action='store_true', help='read the photographs backwards')
    arguments = parser.parse_args()
    (scene,) = scenes_in(arguments.data.resolve(), [arguments.scene], [arguments.scene] if arguments.farthest_first else [])
    (x, y), (width, height) = arguments.at, arguments.size
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for blend in ('linear', 'sharp'):
            (folder / blend).mkdir()
        parts = [titled(picture[y:y + height, x:x + width], title) for title, picture in pictures_of(scene, folder)
                 if picture is not None and picture.shape[:2] == scene.size[::-1]]
    cv2.imwrite(str(arguments.out), np.hstack(parts))


if __name__ == '__main__':
    main()
