#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Sweeps the focus over scenes whose depth is known, runs the built elements, and scores what comes out.

A scene is a folder with view.png, a sharp colour image, and disp.png, its disparity: 8 bits, 0 is unknown, larger is nearer.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

import scores

PLANES = 10
NOISE = ('none', 'moderate', 'strong')
SECONDS_EACH = 300
COLUMNS = (('psnr', 'PSNR dB', '.2f'), ('mae', 'MAE', '.2f'), ('off_by_plane', 'off %', '.2f'),
           ('aif_psnr', 'AIF dB', '.2f'), ('aif_ssim', 'AIF SSIM', '.4f'))


def run_elements(scene, method, noise, blur_step):
    """Plane positions and the all-in-focus image (BGR) that the pipeline makes of a scene.

    method is a property as in a pipeline, method=paper, or empty: dffdepth's own choice.
    """
    view = cv2.imread(str(scene / 'view.png'))
    with tempfile.TemporaryDirectory() as folder:
        depth, aif = pathlib.Path(folder, 'depth'), pathlib.Path(folder, 'aif')
        pipeline = f'''lenssweeptestsrc num-buffers={PLANES} planes={PLANES} scene=files image="{scene}/view.png"
            depth-map="{scene}/disp.png" blur-step={blur_step} noise={noise} seed=1 !
            video/x-raw,format=BGR,width={view.shape[1]},height={view.shape[0]} ! focalstackmux ! tee name=s
            s. ! queue ! dffdepth {method} unit=index ! tee name=d  d. ! queue ! filesink location={depth}
            d. ! queue ! c.depth  s. ! queue ! c.stack
            aifcompose name=c ! videoconvert ! video/x-raw,format=BGR ! filesink location={aif}'''
        finished = subprocess.run(['gst-launch-1.0', '-q', *pipeline.split()], timeout=SECONDS_EACH, text=True,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if finished.returncode != 0:
            raise RuntimeError(f'{scene.name}, noise {noise}: the pipeline failed\n{finished.stdout}')
        pixels = read_rows(depth, view.shape[:2], np.dtype('<u2'), 1)[..., 0]
        image = read_rows(aif, view.shape[:2], np.dtype('u1'), 3)
    return np.maximum(pixels.astype(np.float64) - 1, 0) / 65534 * (PLANES - 1), image


def read_rows(path, shape, dtype, channels):
    """One raw video frame in GStreamer's default layout: each row is padded to a multiple of 4 bytes."""
    height, width = shape
    row = width * channels * dtype.itemsize
    rows = np.fromfile(path, np.uint8).reshape(height, (row + 3) // 4 * 4)
    return np.ascontiguousarray(rows[:, :row]).view(dtype).reshape(height, width, channels)


def score_scene(scene, method, noise, blur_step):
    u, image = run_elements(scene, method, noise, blur_step)
    truth, known = scores.true_depth(cv2.imread(str(scene / 'disp.png'), cv2.IMREAD_UNCHANGED), PLANES)
    return {**scores.depth_scores(u, truth, known, PLANES),
            **scores.all_in_focus_scores(image, cv2.imread(str(scene / 'view.png')))}


def show_progress(done, total, what):
    bar = '#' * (30 * done // total)
    end = '\n' if done == total or not sys.stderr.isatty() else ''
    start = '\r\033[K' if sys.stderr.isatty() else ''
    print(f'{start}[{bar:30}] {done}/{total} {what}', end=end, file=sys.stderr, flush=True)


def averages(rows):
    """Of each column: (10) for what is in dB, and the plain mean."""
    columns = {key: [row[key] for row in rows] for key, _, _ in COLUMNS}
    plain = {key: float(np.mean(values)) for key, values in columns.items()}
    by_ratio = {key: scores.average_psnr(columns[key]) for key in ('psnr', 'aif_psnr')}
    return {'average (10)': by_ratio, 'plain mean': plain}


def print_table(method, noise, rows):
    print(f'\n{method or "the method dffdepth chooses"}, noise={noise}, {PLANES} planes')
    print(f'{"":24}' + ''.join(f'{title:>10}' for _, title, _ in COLUMNS))
    for name, row in rows.items():
        cells = ''.join(f'{row[key]:10{form}}' if key in row else ' ' * 10 for key, _, form in COLUMNS)
        print(f'{name:24}{cells}')


def scenes_in(folder, wanted):
    scenes = [scene for scene in sorted(folder.iterdir())
              if (scene / 'view.png').is_file() and (scene / 'disp.png').is_file()]
    missing = set(wanted or ()) - {scene.name for scene in scenes}
    if missing or not scenes:
        sys.exit(f'{folder} has no scene {", ".join(sorted(missing))}' if missing else
                 f'{folder} holds no folder with a view.png and a disp.png')
    return [scene for scene in scenes if not wanted or scene.name in wanted]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('data', type=pathlib.Path, help='folder of scenes')
    parser.add_argument('--method', nargs='+', default=[], help="dffdepth's method (default: its own choice)")
    parser.add_argument('--scenes', nargs='+', help='names of the scenes to use (default: all)')
    parser.add_argument('--noise', nargs='+', default=NOISE, choices=NOISE, help='default: all three')
    parser.add_argument('--blur-step', type=float, default=2, help='pixels of blur a plane (default: %(default)s)')
    parser.add_argument('--json', type=pathlib.Path, help='where to write the scores as JSON')
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    scenes = scenes_in(arguments.data.resolve(), arguments.scenes)
    methods = [f'method={name}' for name in arguments.method] or ['']
    runs = [(method, noise) for method in methods for noise in arguments.noise]
    total, done, results = len(runs) * len(scenes), 0, []
    for method, noise in runs:
        rows = {}
        for scene in scenes:
            show_progress(done, total, f'{scene.name}, noise {noise}')
            rows[scene.name] = score_scene(scene, method, noise, arguments.blur_step)
            done += 1
        show_progress(done, total, f'noise {noise}: done')
        rows.update(averages(list(rows.values())))
        print_table(method, noise, rows)
        results.append({'method': method, 'noise': noise, 'planes': PLANES, 'scores': rows})
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=2) + '\n')
        print(f'\nwritten to {arguments.json}')


if __name__ == '__main__':
    main()
