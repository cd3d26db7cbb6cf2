# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What the tests of panels and the pictures of the docs share: runs lightfieldcompose on arrays, and looks at elemental images
through their lenses as an eye does."""
import math
import os
import pathlib
import subprocess
import tempfile

import numpy as np

SECONDS = 60


def compose(color, depth, properties, size=None, calibration=None):
    """The picture, height x width x 3, that lightfieldcompose makes of colour (height x width x 3, 8 bits) and depth (height x
    width, 16 bits of unit=index). size: width and height of it, where they can be chosen. calibration: text of a file."""
    height, width = depth.shape
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / 'color').write_bytes(np.ascontiguousarray(color, np.uint8).tobytes())
        (folder / 'depth').write_bytes(np.ascontiguousarray(depth, '<u2').tobytes())
        if calibration:
            (folder / 'display.json').write_text(calibration)
            properties += f' display-calibration={folder}/display.json'
        caps = 'video/x-raw,format=RGB' + (f',width={size[0]},height={size[1]}' if size else '')
        source = f'num-buffers=1 ! rawvideoparse width={width} height={height} framerate=1/1 format='
        pipeline = (f'filesrc location={folder}/color blocksize={3 * height * width} {source}rgb ! queue ! l.color '
                    f'filesrc location={folder}/depth blocksize={2 * height * width} {source}gray16-le ! queue ! l.depth '
                    f'lightfieldcompose name=l {properties} ! {caps} ! '
                    f'tee name=t t. ! queue ! pngenc ! filesink location={folder}/size.png '
                    f't. ! queue ! filesink location={folder}/out')
        environment = dict(os.environ)
        if 'DFF_PRELOAD' in environment:  # gst-launch-1.0 is not built with the sanitizers that our plug-ins want
            environment['LD_PRELOAD'] = environment['DFF_PRELOAD']
        subprocess.run(['gst-launch-1.0', '-q', *pipeline.split()], check=True, timeout=SECONDS, env=environment,
                       stdin=subprocess.DEVNULL)
        header = (folder / 'size.png').read_bytes()[16:24]
        columns, rows = (int.from_bytes(header[i:i + 4], 'big') for i in (0, 4))
        data = np.frombuffer((folder / 'out').read_bytes(), np.uint8)
    return data.reshape(rows, -1)[:, :3 * columns].reshape(rows, columns, 3)


def lens_centers(width, height, pitch, hexagonal=False):
    """Middles of an array's lenses over a panel, one of them over the panel's middle."""
    row_pitch = pitch * (math.sqrt(0.75) if hexagonal else 1.0)
    centers = []
    for row in range(-int(height / row_pitch), int(height / row_pitch) + 1):
        shift = pitch / 2 if hexagonal and row % 2 else 0.0
        for column in range(-int(width / pitch) - 1, int(width / pitch) + 2):
            x, y = width / 2 + column * pitch + shift, height / 2 + row * row_pitch
            if 0 <= x < width and 0 <= y < height:
                centers.append((x, y))
    return np.array(centers)


def seen_by_eye(panel, centers, gap, eye, pitch):
    """What an eye at (x, y, distance), in panel pixels, sees through each lens: a straight line from the eye through the lens's
    middle goes on to the panel, `gap` behind it. NAN where it ends behind a neighbour."""
    height, width, _ = panel.shape
    behind = centers + (centers - eye[:2]) * gap / eye[2]
    seen = np.full((len(centers), 3), np.nan)
    for i, ((x, y), center) in enumerate(zip(behind, centers)):
        if np.hypot(x - center[0], y - center[1]) < pitch / 2 - 0.5 and 0 <= x < width and 0 <= y < height:
            seen[i] = panel[int(y), int(x)]
    return seen
