#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Sweeps the focus over scenes whose depth is known, runs the built elements, and scores what comes out.

A scene is a folder with view.png, a sharp colour image, and disp.png, its disparity: 8 bits, 0 is unknown, larger is nearer;
or it is made: scene=shapes of lenssweeptestsrc by a seed, whose depth the source tells itself.
"""
import argparse
import collections
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

# method: properties of dffdepth as in a pipeline; blend: of aifcompose, '' is its own choice; blur_step: pixels of blur a plane.
Conditions = collections.namedtuple('Conditions', 'method noise breathing blur_step blend', defaults=[''])


class FileScene:
    """A folder with a picture and its disparity."""

    def __init__(self, folder):
        self.folder, self.name = folder, folder.name
        self.view = cv2.imread(str(folder / 'view.png'))
        self.size = self.view.shape[1::-1]
        self.source = f'scene=files image="{folder}/view.png" depth-map="{folder}/disp.png" seed=1'

    def truth(self, _):
        return scores.true_depth(cv2.imread(str(self.folder / 'disp.png'), cv2.IMREAD_UNCHANGED), PLANES)


class MadeScene:
    """Shapes before a wall; no picture of it is sharp everywhere, so that only depth is scored."""

    def __init__(self, seed, size):
        self.name, self.size, self.view = f'shapes {seed}', size, None
        self.source = f'scene=shapes seed={seed}'

    def truth(self, folder):
        path = folder / 'truth'
        run(f'''lenssweeptestsrc name=t num-buffers={PLANES} planes={PLANES} {self.source}
            t.src ! {caps(self.size)} ! queue ! fakesink  t.depth ! queue ! filesink location={path}''')
        pixels = read_rows(path, self.size[::-1], np.dtype('<u2'), 1)[..., 0]
        return to_planes(pixels), pixels > 0


def caps(size):
    return f'video/x-raw,format=BGR,width={size[0]},height={size[1]}'


def to_planes(pixels):
    return np.maximum(pixels.astype(np.float64) - 1, 0) / 65534 * (PLANES - 1)


def run(pipeline):
    finished = subprocess.run(['gst-launch-1.0', '-q', *pipeline.split()], timeout=SECONDS_EACH, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if finished.returncode != 0:
        raise RuntimeError(f'the pipeline failed: {pipeline}\n{finished.stdout}')


def run_elements(scene, conditions, folder):
    """Plane positions and the all-in-focus image (BGR) that the pipeline makes of a scene."""
    depth, aif = folder / 'depth', folder / 'aif'
    align = 'focalstackalign !' if conditions.breathing else ''
    blend = f'blend={conditions.blend}' if conditions.blend else ''
    run(f'''lenssweeptestsrc num-buffers={PLANES} planes={PLANES} {scene.source} blur-step={conditions.blur_step}
        noise={conditions.noise} breathing={conditions.breathing} ! {caps(scene.size)} ! focalstackmux ! {align} tee name=s
        s. ! queue ! dffdepth {conditions.method} unit=index ! tee name=d  d. ! queue ! filesink location={depth}
        d. ! queue ! c.depth  s. ! queue ! c.stack
        aifcompose name=c {blend} ! videoconvert ! video/x-raw,format=BGR ! filesink location={aif}''')
    shape = scene.size[::-1]
    return to_planes(read_rows(depth, shape, np.dtype('<u2'), 1)[..., 0]), read_rows(aif, shape, np.dtype('u1'), 3)


def read_rows(path, shape, dtype, channels):
    """One raw video frame in GStreamer's default layout: each row is padded to a multiple of 4 bytes."""
    height, width = shape
    row = width * channels * dtype.itemsize
    rows = np.fromfile(path, np.uint8).reshape(height, (row + 3) // 4 * 4)
    return np.ascontiguousarray(rows[:, :row]).view(dtype).reshape(height, width, channels)


def score_scene(scene, conditions):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        u, image = run_elements(scene, conditions, folder)
        truth, known = scene.truth(folder)
    result = scores.depth_scores(u, truth, known, PLANES)
    if scene.view is not None:
        result.update(scores.all_in_focus_scores(image, scene.view))
    return result


def show_progress(done, total, what):
    bar = '#' * (30 * done // total)
    end = '\n' if done == total or not sys.stderr.isatty() else ''
    start = '\r\033[K' if sys.stderr.isatty() else ''
    print(f'{start}[{bar:30}] {done}/{total} {what}', end=end, file=sys.stderr, flush=True)


def averages(rows):
    """Of each column: (10) for what is in dB, and the plain mean."""
    columns = {key: [row[key] for row in rows] for key, _, _ in COLUMNS if all(key in row for row in rows)}
    plain = {key: float(np.mean(values)) for key, values in columns.items()}
    by_ratio = {key: scores.average_psnr(columns[key]) for key in ('psnr', 'aif_psnr') if key in columns}
    return {'average (10)': by_ratio, 'plain mean': plain}


def print_table(conditions, rows):
    breathing = f', {conditions.breathing:.1%} of breathing undone' if conditions.breathing else ''
    print(f'\n{conditions.method or "the method dffdepth chooses"}, noise={conditions.noise}, {PLANES} planes{breathing}')
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
    return [FileScene(scene) for scene in scenes if not wanted or scene.name in wanted]


def size_of(text):
    width, height = text.split('x')
    return int(width), int(height)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('data', type=pathlib.Path, help='folder of scenes')
    parser.add_argument('--method', nargs='+', default=[], help="dffdepth's method (default: its own choice)")
    parser.add_argument('--properties', default='', help='more properties of dffdepth, as in a pipeline')
    parser.add_argument('--blend', default='', help="aifcompose's blend (default: its own choice)")
    parser.add_argument('--shapes', nargs='+', type=int, metavar='SEED', help='made scenes instead of those of the folder')
    parser.add_argument('--size', type=size_of, default=(640, 480), help='of made scenes (default: 640x480)')
    parser.add_argument('--breathing', nargs='+', type=float, default=[0], metavar='PART',
                        help='magnification of the last plane minus that of the first, which focalstackalign undoes')
    parser.add_argument('--scenes', nargs='+', help='names of the scenes to use (default: all)')
    parser.add_argument('--noise', nargs='+', default=NOISE, choices=NOISE, help='default: all three')
    parser.add_argument('--blur-step', type=float, default=2, help='pixels of blur a plane (default: %(default)s)')
    parser.add_argument('--json', type=pathlib.Path, help='where to write the scores as JSON')
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    if arguments.shapes:
        scenes = [MadeScene(seed, arguments.size) for seed in arguments.shapes]
    else:
        scenes = scenes_in(arguments.data.resolve(), arguments.scenes)
    methods = [f'method={name}' for name in arguments.method] or ['']
    runs = [Conditions(f'{method} {arguments.properties}'.strip(), noise, breathing, arguments.blur_step, arguments.blend)
            for method in methods for breathing in arguments.breathing for noise in arguments.noise]
    total, done, results = len(runs) * len(scenes), 0, []
    for conditions in runs:
        rows = {}
        for scene in scenes:
            show_progress(done, total, f'{scene.name}, noise {conditions.noise}')
            rows[scene.name] = score_scene(scene, conditions)
            done += 1
        show_progress(done, total, f'noise {conditions.noise}: done')
        rows.update(averages(list(rows.values())))
        print_table(conditions, rows)
        results.append({**conditions._asdict(), 'planes': PLANES, 'scores': rows})
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=2) + '\n')
        print(f'\nwritten to {arguments.json}')


if __name__ == '__main__':
    main()
