#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Runs the built elements on scenes and scores what comes out: depth and picture where the truth is known, otherwise the picture
beside the planes it was made from.

scenes.py says what a folder of scenes may hold. --shapes, --slant and --halo make scenes instead.
"""
import argparse
import collections
import json
import pathlib
import sys
import tempfile

import numpy as np

import elements
import scenes
import scores

NOISE = ('none', 'moderate', 'strong')
COLUMNS = (('psnr', 'PSNR dB', '.2f'), ('mae', 'MAE', '.2f'), ('off_by_plane', 'off %', '.2f'), ('abs_rel', 'AbsRel %', '.2f'),
           ('delta_105', '<1.05 %', '.2f'), ('aif_psnr', 'AIF dB', '.2f'), ('aif_ssim', 'AIF SSIM', '.4f'), ('slope', 'slope', '.2f'),
           ('rms', 'RMS', '.3f'), ('shapes_off', 'shapes %', '.2f'), ('below_best', 'loss dB', '.2f'), ('halo', 'halo %', '.3f'),
           ('invented', 'invented', '.2f'), ('tile', 'tile', '.3f'))

# method: properties of dffdepth as in a pipeline; blend: of aifcompose, '' is its own choice; blur_step: pixels of blur a plane.
Conditions = collections.namedtuple('Conditions', 'method noise breathing blur_step blend', defaults=[''])


def score_scene(scene, conditions):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        return scene.score(elements.compute(scene, conditions, folder), folder)


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
    blend = f', blend={conditions.blend}' if conditions.blend else ''
    print(f'\n{conditions.method or "the method dffdepth chooses"}{blend}, noise={conditions.noise}, '
          f'{conditions.blur_step:g} px of blur a plane{breathing}')
    columns = [column for column in COLUMNS if any(column[0] in row for row in rows.values())]
    print(f'{"":24}' + ''.join(f'{title:>10}' for _, title, _ in columns))
    for name, row in rows.items():
        cells = ''.join(f'{row[key]:10{form}}' if key in row else ' ' * 10 for key, _, form in columns)
        print(f'{name:24}{cells}', flush=True)


def scenes_in(folder, wanted, farthest_first):
    """Those named in `wanted`, or else all whose depth is known."""
    found = {path.name: scenes.scene_in(path, farthest_first) for path in sorted(folder.iterdir())
             if path.is_dir() and (not wanted or path.name in wanted)}
    missing = [name for name in wanted or () if not found.get(name)]
    if missing:
        sys.exit(f'{folder} has no scene {", ".join(missing)}')
    chosen = [scene for scene in found.values() if scene and (wanted or not isinstance(scene, scenes.RealScene))]
    return chosen or sys.exit(f'{folder} holds no folder with a view.png and a disp.png')


def size_of(text):
    width, height = text.split('x')
    return int(width), int(height)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('data', type=pathlib.Path, help='folder of scenes')
    parser.add_argument('--method', nargs='+', default=[], help="dffdepth's method (default: its own choice)")
    parser.add_argument('--properties', default='', help='more properties of dffdepth, as in a pipeline')
    parser.add_argument('--blend', nargs='+', default=[''], help="aifcompose's blend (default: its own choice)")
    parser.add_argument('--shapes', nargs='+', type=int, metavar='SEED', help='made scenes: shapes before a wall')
    parser.add_argument('--slant', nargs='+', type=int, metavar='SEED', help='made scenes: how much depth sticks to the planes')
    parser.add_argument('--halo', nargs='+', type=int, metavar='SEED', help='made scenes: bright shapes on blank ground')
    parser.add_argument('--behind', type=int, default=0, metavar='PLANES',
                        help='how far the ground lies behind the shapes of --halo (default: %(default)s)')
    parser.add_argument('--size', type=size_of, default=(640, 480), help='of --shapes and --slant (default: 640x480)')
    parser.add_argument('--breathing', nargs='+', type=float, default=[0], metavar='PART',
                        help='magnification of the last plane minus that of the first, which focalstackalign undoes')
    parser.add_argument('--scenes', nargs='+', help='names of the scenes to use (default: all but photographs)')
    parser.add_argument('--farthest-first', nargs='+', default=[], metavar='SCENE', help='photographs to be read backwards')
    parser.add_argument('--noise', nargs='+', default=NOISE, choices=NOISE, help='of what is simulated (default: all three)')
    parser.add_argument('--blur-step', nargs='+', type=float, default=[2],
                        help='pixels of blur a plane of what is simulated (default: 2)')
    parser.add_argument('--json', type=pathlib.Path, help='where to write the scores as JSON')
    return parser.parse_args()


def wanted_scenes(arguments):
    made = [scenes.MadeScene(kind, seed, arguments.size) for kind in ('shapes', 'slant') for seed in getattr(arguments, kind) or ()]
    made += [scenes.HaloScene(seed, arguments.behind) for seed in arguments.halo or ()]
    return made or scenes_in(arguments.data.resolve(), arguments.scenes, arguments.farthest_first)


def wanted_runs(arguments, chosen):
    """Where nothing is simulated, noise and blur are as they are."""
    steps, noises = arguments.blur_step, arguments.noise
    if not any(isinstance(scene, (scenes.Simulated, scenes.HaloScene)) for scene in chosen):
        steps = steps[:1]
    if not any(isinstance(scene, scenes.Simulated) for scene in chosen):
        noises = noises[:1]
    methods = [f'method={name}' for name in arguments.method] or ['']
    return [Conditions(f'{method} {arguments.properties}'.strip(), noise, breathing, step, blend)
            for method in methods for blend in arguments.blend for step in steps for breathing in arguments.breathing
            for noise in noises]


def main():
    arguments = parse_arguments()
    chosen = wanted_scenes(arguments)
    runs = wanted_runs(arguments, chosen)
    total, done, results = len(runs) * len(chosen), 0, []
    for conditions in runs:
        rows = {}
        for scene in chosen:
            show_progress(done, total, f'{scene.name}, noise {conditions.noise}')
            rows[scene.name] = score_scene(scene, conditions)
            done += 1
        show_progress(done, total, f'noise {conditions.noise}: done')
        rows.update(averages(list(rows.values())))
        print_table(conditions, rows)
        results.append({**conditions._asdict(), 'scores': rows})
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=2) + '\n')
        print(f'\nwritten to {arguments.json}')


if __name__ == '__main__':
    main()
