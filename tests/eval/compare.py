#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Table 1 of Oliva-García et al. 2022 as far as it can be had: accuracy beside time, ours beside other people's ways (peers.py),
on the same planes, in Markdown.

Time is processor time of a stack, of all threads; of our elements without what starts a pipeline, of programs with their start.
"""
import argparse
import collections
import pathlib
import resource
import tempfile
import time

import cv2
import numpy as np

import elements
import peers
import scenes
import scores
from evaluate import NOISE, Conditions, scenes_in, show_progress

OURS = (('method=volume', '', 'blend=soft'), ('method=paper', '', 'blend=soft'))  # dffdepth, more of it, aifcompose
REPEATS = 5  # stacks more than one, of which our time is the mean

Row = collections.namedtuple('Row', 'name depth picture milliseconds')


def children_ms():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (used.ru_utime + used.ru_stime) * 1000


def timed(work):
    before = time.process_time() * 1000 + children_ms()
    result = work()
    return result, time.process_time() * 1000 + children_ms() - before


def run_ours(scene, stack, method, blend, folder):
    """Depth and picture of a stack in a file, and what one stack more costs."""
    depth, picture = folder / 'depth', folder / 'picture'
    size = f'width={scene.size[0]},height={scene.size[1]}'

    def pipeline(stacks):
        elements.run(f'''multifilesrc location={stack} num-buffers={stacks}
            caps=video/x-focal-stack,format=BGR,{size},planes={scene.planes},framerate=26/1 ! tee name=s
            s. ! queue ! dffdepth {method} unit=index ! tee name=d  d. ! queue ! filesink location={depth}
            d. ! queue ! c.depth  s. ! queue ! c.stack
            aifcompose name=c {blend} ! filesink location={picture}''')
    pipeline(1)  # compiles kernels
    _, many = timed(lambda: pipeline(1 + REPEATS))
    _, one = timed(lambda: pipeline(1))
    shape = scene.size[::-1]
    u = elements.depth_in_planes(elements.read_rows(depth, shape, np.dtype('<u2'), 1)[..., 0], scene.planes)
    return u, elements.read_rows(picture, shape, np.dtype('u1'), 3), (many - one) / REPEATS


def depth_row(scene, u):
    truth, known = scene.truth()
    return scores.depth_scores(u, truth, known, scene.planes)


def rows_of(scene, noise, blur_step, folder):
    """What every way makes of one scene."""
    stack = folder / 'stack'
    elements.run(f'{scene.source(Conditions("", noise, 0, blur_step), folder)} ! focalstackmux ! filesink location={stack}')
    planes = elements.read_frames(stack, scene.size[::-1], np.dtype('u1'), 3)
    for method, properties, blend in OURS:
        u, picture, cost = run_ours(scene, stack, f'{method} {properties}', blend, folder)
        yield Row(method, depth_row(scene, u), scores.all_in_focus_scores(picture, scene.sharp), cost)
    gray = np.stack([cv2.cvtColor(plane, cv2.COLOR_BGR2GRAY) for plane in planes])
    for name, work in peers.DEPTH.items():
        u, cost = timed(lambda work=work: work(gray))
        yield Row(name, depth_row(scene, u), {}, cost)
    files = folder / 'planes'
    files.mkdir()
    for z, plane in enumerate(planes):
        cv2.imwrite(str(files / f'{z:02d}.png'), plane)
    for name in peers.installed():
        picture, cost = timed(lambda name=name: peers.make_picture(name, files, folder / f'{name}.png'))
        if picture is not None and picture.shape == scene.sharp.shape:
            yield Row(name, {}, scores.all_in_focus_scores(picture, scene.sharp), cost)


def table(rows, noises):
    """One line a way: means over the scenes, the noise levels side by side."""
    levels = ' / '.join(noises)
    lines = [f'| | depth PSNR dB, {levels} | AbsRel % | within 1.05, % | picture PSNR dB, {levels} | processor ms a stack |',
             '|---|---|---|---|---|---|']
    for name in dict.fromkeys(row.name for _, row in rows):
        def mean(part, key, form, name=name):
            found = [[getattr(row, part)[key] for noise, row in rows if row.name == name and noise == level and key in
                      getattr(row, part)] for level in noises]
            return ' / '.join(f'{np.mean(values):{form}}' for values in found if values)
        cost = np.mean([row.milliseconds for _, row in rows if row.name == name])
        lines.append(f'| {name} | {mean("depth", "psnr", ".1f")} | {mean("depth", "abs_rel", ".1f")} | '
                     f'{mean("depth", "delta_105", ".0f")} | {mean("picture", "aif_psnr", ".1f")} | {cost:.0f} |')
    return '\n'.join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('data', type=pathlib.Path, help='folder of scenes with view.png and disp.png')
    parser.add_argument('--scenes', nargs='+', help='names of the scenes to use (default: all)')
    parser.add_argument('--noise', nargs='+', default=NOISE, choices=NOISE, help='default: all three')
    parser.add_argument('--blur-step', type=float, default=2, help='pixels of blur a plane (default: %(default)s)')
    arguments = parser.parse_args()
    chosen = [scene for scene in scenes_in(arguments.data.resolve(), arguments.scenes, ()) if isinstance(scene, scenes.FileScene)]
    rows, done = [], 0
    for noise in arguments.noise:
        for scene in chosen:
            show_progress(done, len(arguments.noise) * len(chosen), f'{scene.name}, noise {noise}')
            with tempfile.TemporaryDirectory() as name:
                rows += [(noise, row) for row in rows_of(scene, noise, arguments.blur_step, pathlib.Path(name))]
            done += 1
    print(table(rows, list(arguments.noise)))


if __name__ == '__main__':
    main()
