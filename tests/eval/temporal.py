#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""temporal.py [--help]: what focalstackdenoise and dffdepth steady=on make of noise, by the simulated camera. In `meson devenv`.

still     A scene that stands still: depth in dB of the whole range against the truth, picture in dB against that of the same sweeps without
          noise, and flicker: standard deviation of each pixel's depth from sweep to sweep, in planes. Means of the sweeps from JUDGED on.
scenes    The scenes of --data (see docs/scoring.md), rendered as many times: depth and picture of the last sweep. Needs OpenCV and
          scikit-image for Python: start it as run.sh starts evaluate.py.
changes   The first sweep after a cut and after a light was switched, and each while the camera pans: how many dB depth and picture are
          below what they are without denoising; less than 0 is better.
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

from elements import run
from moving import HEIGHT, PLANES, WIDTH, camera, computed

JUDGED = 8  # sweeps before are not
DENOISE = 'focalstackdenoise frames=16 !'
WAYS = [('alone', '', 'dffdepth'), ('denoised', DENOISE, 'dffdepth'), ('and steady', DENOISE, 'dffdepth steady=on')]


def decibel(errors, peak):
    return 10 * np.log10(peak ** 2 / max(float((errors.astype(np.float64) ** 2).mean()), 1e-9))


def told(name, values):
    return f'{name} depth {values[0]:.2f} dB, picture {values[1]:.2f} dB' + (f', flicker {values[2]:.4f} planes' if len(values) > 2 else '')


def of_each_sweep(found, truth, clean):
    """Depth and picture, in dB."""
    depth, picture = found
    return np.array([(decibel(depth[i].astype(np.float64) - truth[i], 65534), decibel(picture[i].astype(np.float64) - clean[i], 255))
                     for i in range(len(depth))])


def sweeps(options, arguments, where):
    """The truth, the pictures without noise, and what each of WAYS makes of the sweeps."""
    options = f'{options} blur-step={arguments.blur_step}'
    camera(options, where)
    clean = computed(where, '')[1]
    camera(f'{options} noise={arguments.noise}', where)
    truth = np.fromfile(where / 'depth', '<u2').reshape(-1, HEIGHT, WIDTH).astype(np.float64)
    return truth, clean, [(name, computed(where, way, depth)) for name, way, depth in WAYS]


def still(arguments, where):
    scored = {}
    for seed in arguments.seeds:
        truth, clean, all_found = sweeps(f'num-buffers={PLANES * 16} seed={seed}', arguments, where)
        for name, found in all_found:
            scores = of_each_sweep(found, truth, clean)[JUDGED:].mean(0)
            flicker = (found[0][JUDGED:].astype(np.float64) / 65534 * (PLANES - 1)).std(0).mean()
            scored.setdefault(name, []).append((*scores, flicker))
            print(f'still, seed {seed}: {told(name, scored[name][-1])}', flush=True)
    for name, values in scored.items():
        print(f'still, mean of {len(values)} seeds: {told(name, np.mean(values, 0))}', flush=True)


def rendered(scene, count, noise, blur_step, where):
    """Sweeps of a scene, as raw stacks."""
    run(f'lenssweeptestsrc num-buffers={PLANES * count} planes={PLANES} {scene.content} blur-step={blur_step} noise={noise} ! '
        f'video/x-raw,format=RGB,width={scene.size[0]},height={scene.size[1]} ! focalstackmux ! {where}')


def scenes(arguments, where):
    from elements import depth_in_planes, read_frames
    from scenes import FileScene
    folders = [Path(arguments.data) / name for name in arguments.scenes]
    scored = {}
    for scene in map(FileScene, folders):
        for name, way, depth in WAYS:
            rendered(scene, 16, arguments.noise, arguments.blur_step,
                     f'{way} tee name=s  s. ! queue ! {depth} unit=index ! tee name=d  d. ! queue ! filesink location={where}/found '
                     f's. ! queue ! c.stack  d. ! queue ! c.depth  aifcompose name=c ! videoconvert ! video/x-raw,format=BGR ! '
                     f'filesink location={where}/picture')
            shape = scene.size[::-1]
            u = depth_in_planes(read_frames(where / 'found', shape, np.dtype('<u2'), 1)[-1, ..., 0], PLANES)
            picture = read_frames(where / 'picture', shape, np.dtype('u1'), 3)[-1]
            found = scene.score(argparse.Namespace(u=u, picture=picture), None)
            scored.setdefault(name, []).append((found['psnr'], found['aif_psnr']))
            print(f'{scene.name}, 16 sweeps: {told(name, scored[name][-1])}', flush=True)
    for name, values in scored.items():
        print(f'mean of {len(values)} scenes: {told(name, np.mean(values, 0))}', flush=True)


def changes(arguments, where):
    after = 6  # sweeps
    kinds = [('a cut', f'cut={PLANES * after}', after), ('a light switched', f'light-switch={PLANES * after}', after), ('a pan', 'pan=3', 1)]
    for seed in arguments.seeds:
        for name, option, first in kinds:
            truth, clean, all_found = sweeps(f'num-buffers={PLANES * (after + 2)} seed={seed} {option}', arguments, where)
            alone = of_each_sweep(all_found[0][1], truth, clean)[first:]
            for way, found in all_found[1:]:
                loss = alone - of_each_sweep(found, truth, clean)[first:]
                worst = loss[0] if first == after else loss.max(0)
                print(f'{name}, seed {seed}, {way}: depth {worst[0]:+.2f} dB below, picture {worst[1]:+.2f} dB below', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('what', nargs='*', help='still, scenes, changes; still and changes where none is named')
    parser.add_argument('--noise', default='strong')
    parser.add_argument('--seeds', nargs='+', type=int, default=[3, 4, 5, 6, 7, 8])
    parser.add_argument('--data', help='folder of the scenes')
    parser.add_argument('--scenes', nargs='+', default=['Art_T', 'Dolls_T', 'Laundry_T', 'Moebius_T', 'Aloe_H', 'Teddy_Q'])
    parser.add_argument('--blur-step', type=float, default=2.0, help='pixels a plane')
    arguments = parser.parse_args()
    work = {'still': still, 'scenes': scenes, 'changes': changes}
    wanted = arguments.what or ['still', 'changes']
    if unknown := set(wanted) - set(work):
        sys.exit(f'temporal.py: there is no {", ".join(sorted(unknown))}: still, scenes or changes')
    if 'scenes' in wanted and not arguments.data:
        sys.exit('temporal.py: scenes needs --data FOLDER')
    with tempfile.TemporaryDirectory() as folder:
        for name in wanted:
            work[name](arguments, Path(folder))


if __name__ == '__main__':
    main()
