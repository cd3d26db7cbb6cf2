# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Runs the built elements, and reads what they leave in files."""
import collections
import subprocess

import numpy as np

SECONDS_EACH = 300

# u: plane positions; picture: the all-in-focus image, BGR; stack: the planes as they were when it was made, where they were aligned.
Result = collections.namedtuple('Result', 'u picture stack')


def run(pipeline):
    finished = subprocess.run(['gst-launch-1.0', '-q', *pipeline.split()], timeout=SECONDS_EACH, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if finished.returncode != 0:
        raise RuntimeError(f'the pipeline failed: {pipeline}\n{finished.stdout}')


def depth_in_planes(pixels, planes):
    """Plane positions of pixels of unit=index."""
    return np.maximum(pixels.astype(np.float64) - 1, 0) / 65534 * (planes - 1)


def read_rows(path, shape, dtype, channels):
    """One raw video frame in GStreamer's default layout: each row is padded to a multiple of 4 bytes."""
    return read_frames(path, shape, dtype, channels)[0]


def read_frames(path, shape, dtype, channels):
    """The same of a stack's frames, which follow each other."""
    height, width = shape
    row = width * channels * dtype.itemsize
    rows = np.fromfile(path, np.uint8).reshape(-1, height, (row + 3) // 4 * 4)
    return np.ascontiguousarray(rows[:, :, :row]).view(dtype).reshape(-1, height, width, channels)


def compute(scene, conditions, folder):
    """What the pipeline makes of a scene."""
    depth, picture, stack = (folder / name for name in ('depth', 'picture', 'stack'))
    align = 'focalstackalign !' if scene.aligned or conditions.breathing else ''
    blend = f'blend={conditions.blend}' if conditions.blend else ''
    keep = f's. ! queue ! filesink location={stack}' if scene.aligned else ''
    run(f'''{scene.source(conditions, folder)} ! focalstackmux ! {align} tee name=s
        s. ! queue ! dffdepth {conditions.method} unit=index ! tee name=d  d. ! queue ! filesink location={depth}
        d. ! queue ! c.depth  s. ! queue ! c.stack  {keep}
        aifcompose name=c {blend} ! videoconvert ! video/x-raw,format=BGR ! filesink location={picture}''')
    shape, byte = scene.size[::-1], np.dtype('u1')
    return Result(depth_in_planes(read_rows(depth, shape, np.dtype('<u2'), 1)[..., 0], scene.planes),
                  read_rows(picture, shape, byte, 3), read_frames(stack, shape, byte, 3) if scene.aligned else None)
