#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""photographs.py FOLDER [PROGRAM...]: dff-stack beside other programs on one folder of photographs: processor time, memory, and how good
the picture is. Programs that are not installed are left out.

Each aligns by its own means, to the middle picture, but enfuse, which does not align and gets the pictures aligned by dff-stack. The
measures compare with pictures so aligned too.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import cv2
import numpy as np

import scores

DFF_STACK = pathlib.Path(__file__).resolve().parents[2] / 'pipelines/stack/dff-stack'
PROGRAMS = {'dff-stack': ['/usr/bin/python3', str(DFF_STACK), '{folder}', '--output', '{picture}', '--save-alignment', '{alignment}'],
            'focus-stack': ['focus-stack', '--no-whitebalance', '--no-contrast', '--align-keep-size', '--output={picture}', '{files}'],
            'focusweave': ['focusweave', '{folder}', '--keep-size', '--output', '{picture}'],
            'enfuse': ['enfuse', '--exposure-weight=0', '--saturation-weight=0', '--contrast-weight=1', '--hard-mask',
                       '--output={picture}', '{aligned}']}


def command(name, **places):
    """The words of a program's call; `files` and `aligned` are many words."""
    words = []
    for word in PROGRAMS[name]:
        many = places.get(word.strip('{}')) if word in ('{files}', '{aligned}') else None
        words += many if many is not None else [word.format(**places)]
    return words


def run(words):
    """Processor seconds, seconds, and mebibytes at most."""
    start = time.monotonic()
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        sys.exit(f'{words[0]} failed: {errors.decode(errors="replace")[-400:]}')
    return {'processor': usage.ru_utime + usage.ru_stime, 'wall': time.monotonic() - start, 'memory': usage.ru_maxrss / 1024}


def aligned(files, alignment):
    """The pictures as dff-stack's alignment lays them, one at a time."""
    warps = {plane['picture']: np.array(plane['matrix']).reshape(3, 3) for plane in json.loads(alignment.read_text())['planes']}
    for file in files:
        if file.name not in warps:  # it was left out
            continue
        picture = cv2.imread(str(file))
        height, width = picture.shape[:2]
        centre = np.array([[1, 0, (width - 1) / 2], [0, 1, (height - 1) / 2], [0, 0, 1]])
        yield cv2.warpPerspective(picture, centre @ warps[file.name] @ np.linalg.inv(centre), (width, height),
                                  flags=cv2.INTER_LANCZOS4 | cv2.WARP_INVERSE_MAP, borderMode=cv2.BORDER_REFLECT_101)


def write_aligned(files, alignment, folder):
    folder.mkdir()
    names = [str(folder / f'{file.stem}.tif') for file in files]
    for name, picture in zip(names, aligned(files, alignment)):
        cv2.imwrite(name, picture)
    return [name for name in names if pathlib.Path(name).exists()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=pathlib.Path, help='photographs of one sweep')
    parser.add_argument('programs', nargs='*', metavar='PROGRAM', help=f'of {", ".join(PROGRAMS)}; default: those that are installed')
    arguments = parser.parse_args()
    files = sorted(file for file in arguments.folder.iterdir() if cv2.haveImageReader(str(file)))
    wanted = arguments.programs or [name for name in PROGRAMS if name == 'dff-stack' or shutil.which(name)]
    wanted = ['dff-stack'] + [name for name in wanted if name != 'dff-stack']  # whose alignment the others' scores need
    print(f'{len(files)} pictures\n\n| | processor s | s | MiB | invented | tile |\n|---|---|---|---|---|---|', flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        alignment, laid = scratch / 'alignment.json', None
        for name in wanted:
            picture = scratch / f'{name}.tif'
            if name == 'enfuse':
                laid = write_aligned(files, alignment, scratch / 'aligned')
            cost = run(command(name, folder=arguments.folder, picture=picture, alignment=alignment, files=[str(file) for file in files],
                               aligned=laid))
            found = scores.real_scores(cv2.imread(str(picture)), aligned(files, alignment))
            print(f'| {name} | {cost["processor"]:.0f} | {cost["wall"]:.0f} | {cost["memory"]:.0f} | {found["invented"]:.2f} | '
                  f'{found["tile"]:.3f} |', flush=True)


if __name__ == '__main__':
    main()
