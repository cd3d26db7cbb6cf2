#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""light_field_pictures.py [FOLDER]: makes the pictures of light-field.md, one a layout and one of what five eyes see through a
lens array. Run it inside `meson devenv -C build`."""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'tests/unit/lightfield'))
import light_field  # noqa: E402

WIDTH, HEIGHT = 640, 480
DISPLAY = {'pitch': 20.1, 'slope': -6.5, 'center': 0.2, 'viewCone': 40, 'DPI': 100, 'screenW': 360, 'screenH': 270}


def sweep():
    """Colour and depth of one simulated sweep, as aifcompose and dffdepth make them."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(['gst-launch-1.0', '-q', *f'''
            lenssweeptestsrc num-buffers=10 planes=10 ! video/x-raw,format=RGB,width={WIDTH},height={HEIGHT} ! focalstackmux !
            tee name=s  s. ! queue ! dffdepth unit=index ! tee name=d  d. ! queue ! c.depth  s. ! queue ! c.stack
            aifcompose name=c ! filesink location={folder}/color  d. ! queue ! filesink location={folder}/depth'''.split()],
                       check=True, timeout=120)
        color = np.fromfile(f'{folder}/color', np.uint8).reshape(HEIGHT, WIDTH, 3)
        return color, np.fromfile(f'{folder}/depth', '<u2').reshape(HEIGHT, WIDTH)


def write(path, picture):
    """A JPEG file."""
    height, width, _ = picture.shape
    with tempfile.NamedTemporaryFile() as file:
        file.write(np.ascontiguousarray(picture).tobytes())
        file.flush()
        subprocess.run(['gst-launch-1.0', '-q', *f'''
            filesrc location={file.name} blocksize={picture.size} ! rawvideoparse format=rgb width={width} height={height} !
            videoconvert ! jpegenc quality=70 ! filesink location={path}'''.split()], check=True, timeout=60)


def five_eyes(color, depth):
    """What eyes from left to right see through the lenses of a panel."""
    width, height, pitch, gap = 1280, 960, 8, 11.0
    panel = light_field.compose(color, depth, f'layout=elemental pitch={pitch} gap={gap} depth-gain=0.3 center-x={pitch / 2} '
                                f'center-y={pitch / 2}', size=(width, height))
    y, x = np.mgrid[pitch / 2:height:pitch, pitch / 2:width:pitch]
    centers = np.stack([x.ravel(), y.ravel()], axis=1)
    views = []
    for eye_x in (-700, -350, 0, 350, 700):
        eye = np.array([width / 2 + eye_x, height / 2, 6000.0])
        seen = light_field.seen_by_eye(panel, centers, gap, eye, pitch)
        views.append(np.nan_to_num(seen).astype(np.uint8).reshape(*x.shape, 3))
    return np.hstack(views)


def main(folder):
    color, depth = sweep()
    calibration = json.dumps(DISPLAY)
    for name, properties, size in (
            ('quilt', 'columns=5 rows=3', (500, 225)), ('views', 'layout=views columns=2 view-cone=20', (560, 210)),
            ('rgbd', 'layout=rgbd', None), ('lenticular', 'layout=lenticular', None),
            ('elemental', 'layout=elemental pitch=15.5 grid=hex', (360, 270))):
        picture = light_field.compose(color, depth, properties, size, calibration if name == 'lenticular' else None)
        if name == 'rgbd':
            picture = picture[::2, ::2]
        write(folder / f'light-field-{name}.jpg', picture)
    write(folder / 'light-field-five-eyes.jpg', five_eyes(color, depth))


if __name__ == '__main__':
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / 'docs')
