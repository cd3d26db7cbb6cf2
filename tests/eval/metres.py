#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How true depth in millimetres is: calibrates the simulated rig by boards alone, and measures a slanted plane and steps with it.

For each scene and noise: the mean error in planes, of all pixels, of those without an edge near and of the worst ninth of the
picture; and, as uncertainty.py, percent within one and two of the standard deviations that are told, in millimetres too."""
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

from elements import read_rows, run
from uncertainty import NOISES, content_of, groups, line, steps

NEAR, FAR, PLANES = 3.9, 0.4, 6  # beyond 0.3 and 1.5 m, since the field is bent: in the corners the sweep ends farther away
STEP = (NEAR - FAR) / (PLANES - 1)
SIZE = (640, 480)
STRIP = 8  # pixels
RIG = 'breathing=0.03 field-curvature=0.5 vignetting=0.05'
CAMERA = '''%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 800., 0., 319.5, 0., 800., 239.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.05, 0.01, 0., 0., 0. ]
'''
POSES = ('0,-0.01,0.33,20,8,3', '0.03,0.02,0.33,-25,5,0', '-0.03,-0.02,0.36,5,25,-5', '-0.05,0.04,0.40,10,-28,10',
         '0.06,-0.03,0.45,-20,-15,0', '0.08,0.07,0.52,25,20,-8', '-0.11,-0.07,0.60,-22,18,5', '0.14,-0.10,0.72,15,-25,0',
         '-0.18,0.12,0.86,-28,-10,12', '0.22,0.15,1.05,24,-12,-4', '-0.28,-0.20,1.28,-20,25,0', '0.10,0.05,1.45,28,15,6')
SWEEP = f'lenssweeptestsrc name=t num-buffers={PLANES} planes={PLANES} near={NEAR} far={FAR} {RIG}'


def calibrate(folder):
    camera, found = folder / 'camera.yml', folder / 'found.yml'
    camera.write_text(CAMERA)
    sources = []
    for pose in POSES:
        sources += ['--source', f'{SWEEP} scene=board board=10x7x20 calibration={camera} pose={pose} noise=moderate']
    print(subprocess.run(['dff-calibrate', '--board', '10x7x20', '--output', found, *sources], check=True, text=True,
                         stdout=subprocess.PIPE).stdout)
    return found


def measure(content, noise, calibration, folder):
    """The errors in planes, their groups, and the deviations that are told."""
    files = {name: folder / name for name in ('depth', 'uncertainty', 'sparse', 'truth')}
    run(f'''{SWEEP} {content} noise={noise}
        t.src ! video/x-raw,format=BGR,width={SIZE[0]},height={SIZE[1]} ! queue max-size-buffers=70 max-size-bytes=0 !
        focalstackmux ! focalstackalign mode=calibration calibration={calibration} !
        dffdepth name=d unit=millimetre calibration={calibration}  d.src ! queue ! filesink location={files['depth']}
        d.uncertainty ! queue ! filesink location={files['uncertainty']}
        d.sparse ! queue ! filesink location={files['sparse']}
        t.depth ! queue ! filesink location={files['truth']}''')
    maps = {name: read_rows(file, SIZE[::-1], np.dtype('<u2'), 1)[..., 0].astype(float) for name, file in files.items()}
    known = (maps['truth'] > 0) & (maps['depth'] > 0)
    known[:, :5 * STRIP] = False
    truth = NEAR - (maps['truth'] - 1) / 65534 * (NEAR - FAR)
    off = (truth - 1e3 / np.maximum(maps['depth'], 1)) / STEP
    deviation = maps['uncertainty'] * truth ** 2 / 1e3 / STEP
    return off, groups((NEAR - truth) / STEP, known, maps['sparse'] > 0), deviation


def within_sweep(folder):
    """steps(), whose ends lie within the sweep: strips at the side of the picture take the sweep's ends, and are left out."""
    steps(folder)
    disparity = cv2.imread(str(folder / 'disp.png'), cv2.IMREAD_UNCHANGED).astype(float)
    vergence = 1 / 1.5 + (disparity - 2000) / 60000 * (1 / 0.3 - 1 / 1.5)
    vergence[:200, :STRIP], vergence[-200:, :STRIP] = NEAR, FAR
    cv2.imwrite(str(folder / 'disp.png'), (2000 + 60000 * (vergence - FAR) / (NEAR - FAR)).astype(np.uint16))
    return folder


def worst_ninth(off, mask):
    """The mean error of that part of nine whose mean is the largest."""
    rows, columns = (np.array_split(np.arange(side), 3) for side in SIZE[::-1])
    parts = [(off[cells], mask[cells]) for cells in (np.ix_(y, x) for y in rows for x in columns)]
    return max((part[some].mean() for part, some in parts if some.any()), key=abs)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        calibration = calibrate(folder)
        scenes = {'slant': 'scene=slant seed=1', 'steps': content_of(within_sweep(folder / 'steps'))[0]}
        print(f'{"":18}mean error, planes         within 1 / 2 deviations, percent\n'
              f'{"":18}all    elsewhere worst     all         edges       elsewhere   filled')
        for scene, content in scenes.items():
            for noise in NOISES:
                off, masks, deviation = measure(content, noise, calibration, folder)
                counts = {group: np.array([mask.sum(), (abs(off) <= deviation)[mask].sum(),
                                           (abs(off) <= 2 * deviation)[mask].sum()]) for group, mask in masks.items()}
                even = masks['elsewhere']
                print(f'{scene + ", " + noise:16}  {off[masks["all"]].mean():6.3f}  {off[even].mean():6.3f}  '
                      f'{worst_ninth(off, even):6.3f}    {line("", counts)[34:]}', flush=True)


if __name__ == '__main__':
    sys.exit(main())
