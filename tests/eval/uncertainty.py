#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How true the pad uncertainty of dffdepth is: uncertainty.py [FOLDER...], each with view.png and disp.png.

For each scene, blur step and noise, and for all of them: percent of the pixels whose depth lies within one and within two of
the standard deviations that are told for them (68 and 95 where they are true), in all of the picture, within 6 pixels of a
depth edge of more than a plane, elsewhere, and where depth is filled: where it is not in the pad sparse."""
import argparse
import collections
import pathlib
import sys
import tempfile

import cv2
import numpy as np

from elements import depth_in_planes, read_rows, run

NOISES = ('none', 'moderate', 'strong')
CONDITIONS = ((2, 10), (4, 10), (2, 6))  # pixels of blur a plane, planes
EDGE = 6  # pixels
MADE = {'slant 1': ('scene=slant seed=1', (640, 480)), 'shapes 3': ('scene=shapes seed=3', (640, 480))}


def steps(folder):
    """Textured boards at 0.3 to 1.5 m, the lower third of each blank."""
    random = np.random.default_rng(5)
    height, width = 480, 640
    picture = np.full((height, width, 3), 110, np.float32)
    for grain, strength in ((2, 18), (4, 18), (8, 16), (32, 20)):
        noise = random.normal(size=(height // grain + 2, width // grain + 2, 3)).astype(np.float32)
        noise = cv2.resize(noise, (width + 2 * grain, height + 2 * grain), interpolation=cv2.INTER_CUBIC)
        picture += strength * noise[grain:grain + height, grain:grain + width]
    vergence = np.zeros((height, width), np.float32)
    for i, metres in enumerate((0.3, 1.5, 0.45, 1.0, 0.6, 1.3, 0.35)):
        columns = slice(i * width // 7, (i + 1) * width // 7)
        vergence[:, columns] = 1 / metres
        picture[340:, columns] = 90 + 20 * i
    vergence[200:280] = 1 / 0.8
    folder.mkdir()
    cv2.imwrite(str(folder / 'view.png'), np.clip(picture, 0, 255).astype(np.uint8))
    cv2.imwrite(str(folder / 'disp.png'), (2000 + 60000 * (vergence - 1 / 1.5) / (1 / 0.3 - 1 / 1.5)).astype(np.uint16))
    return folder


def content_of(folder):
    size = cv2.imread(str(folder / 'view.png')).shape[1::-1]
    return f'scene=files image="{folder}/view.png" depth-map="{folder}/disp.png" seed=1', size


def groups(truth, known, seen):
    square = np.ones((2 * EDGE + 1, 2 * EDGE + 1), np.uint8)
    far = cv2.dilate(np.where(known, truth, -1e3).astype(np.float32), square)
    near = cv2.erode(np.where(known, truth, 1e3).astype(np.float32), square)
    edge = far - near > 1
    return {'all': known, 'edges': known & edge, 'elsewhere': known & ~edge, 'filled': known & ~seen}


def measure(content, size, noise, blur, planes, folder):
    """Of each group: pixels, and how many lie within one and two standard deviations."""
    files = {name: folder / name for name in ('depth', 'uncertainty', 'sparse', 'truth')}
    run(f'''lenssweeptestsrc name=t num-buffers={planes} planes={planes} {content} blur-step={blur} noise={noise}
        t.src ! video/x-raw,format=BGR,width={size[0]},height={size[1]} ! queue max-size-buffers=70 max-size-bytes=0 !
        focalstackmux ! dffdepth name=d unit=index  d.src ! queue ! filesink location={files['depth']}
        d.uncertainty ! queue ! filesink location={files['uncertainty']}
        d.sparse ! queue ! filesink location={files['sparse']}
        t.depth ! queue ! filesink location={files['truth']}''')
    maps = {name: read_rows(file, size[::-1], np.dtype('<u2'), 1)[..., 0] for name, file in files.items()}
    truth, known = depth_in_planes(maps['truth'], planes), maps['truth'] > 0
    off = np.abs(depth_in_planes(maps['depth'], planes) - truth)
    deviation = maps['uncertainty'] / 65534 * (planes - 1)
    return {name: np.array([mask.sum(), (off <= deviation)[mask].sum(), (off <= 2 * deviation)[mask].sum()])
            for name, mask in groups(truth, known, maps['sparse'] > 0).items()}


def line(name, counts):
    cells = (f'{100 * one / pixels:3.0f} / {100 * two / pixels:3.0f}' if pixels > 500 else '    -    '
             for pixels, one, two in counts.values())
    return f'{name:32}  ' + '   '.join(cells)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('folders', nargs='*', type=pathlib.Path)
    folders = parser.parse_args().folders
    total = {noise: collections.defaultdict(lambda: np.zeros(3)) for noise in NOISES}
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        scenes = dict(MADE, steps=content_of(steps(scratch / 'steps')), **{f.name: content_of(f.resolve()) for f in folders})
        print(f'{"within 1 / 2 deviations, percent":32}  all         edges       elsewhere   filled')
        for scene, (content, size) in scenes.items():
            for blur, planes in CONDITIONS:
                for noise in NOISES:
                    counts = measure(content, size, noise, blur, planes, scratch)
                    print(line(f'{scene}, {blur} px, {planes} planes, {noise}', counts), flush=True)
                    for group, count in counts.items():
                        total[noise][group] += count / counts['all'][0]  # scenes weigh the same
    for noise in NOISES:
        print(line(f'all, {noise}', {group: 1e6 * count for group, count in total[noise].items()}))


if __name__ == '__main__':
    sys.exit(main())
