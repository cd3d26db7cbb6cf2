# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A short video that rocks to and fro before the scene, of views that lightfieldcompose renders."""
import numpy as np

from dff_stack import engine, results
from dff_stack.encoding import Encoding

VIEWS = 24
WIDEST = 640         # of a view, in pixels and even
FRAMES_A_SECOND = 24
ROUNDS = 2
CONE = 16            # degrees between the outermost views
COLOURS = Encoding('RGB', 3, 'u1', False)


def view_size(width, height):
    """Even numbers, since video is made of pairs of pixels."""
    longest = max(width, height)
    scale = min(1.0, WIDEST / longest)
    return max(2, int(width * scale) // 2 * 2), max(2, int(height * scale) // 2 * 2)


def shrunk(pixels, size):
    """To a smaller size: the mean of squares of whole pixels, then the nearest."""
    width, height = size
    factor = max(1, min(pixels.shape[1] // width, pixels.shape[0] // height))
    rows, columns = pixels.shape[0] // factor, pixels.shape[1] // factor
    means = pixels[:rows * factor, :columns * factor].reshape(rows, factor, columns, factor, -1).mean((1, 3))
    return np.round(nearest(means, size)).astype(pixels.dtype)


def nearest(pixels, size):
    width, height = size
    rows = (np.arange(height) + 0.5) * pixels.shape[0] / height
    columns = (np.arange(width) + 0.5) * pixels.shape[1] / width
    return pixels[rows.astype(int)][:, columns.astype(int)]


def views_of(colours, code, tell):
    """The scene from VIEWS places, the leftmost first. `code`: 16 bits, 0 = not known."""
    height, width = code.shape
    description = (f'appsrc name=depth format=time ! queue ! l.depth  {engine.SOURCE} ! queue ! l.color  '
                   f'lightfieldcompose name=l layout=views columns={VIEWS} view-cone={CONE} ! '
                   f'video/x-raw,format=RGB,width={VIEWS * width},height={height} ! {engine.sink("views")}')
    with engine.running(description, tell) as run:
        run.push('depth', engine.stack_buffer([code.astype('<u2')[:, :, None]], 1, engine.DEPTH, width, height),
                 f'video/x-raw,format=GRAY16_LE,width={width},height={height},framerate=1/1')
        views, = run.results(engine.stack_buffer([colours], 1, COLOURS, width, height),
                             f'video/x-raw,format=RGB,width={width},height={height},framerate=1/1', ('views',))
    row = engine.array_of(views, 'u1', 3)
    return [row[:, k * width:(k + 1) * width] for k in range(VIEWS)]


def rocking():
    """Numbers of views: slowly at the turns, as a pendulum goes."""
    phase = np.arange(VIEWS * 2) * np.pi / VIEWS
    once = np.round((1 - np.cos(phase)) / 2 * (VIEWS - 1)).astype(int)
    return list(once) * ROUNDS


def write(path, colours, depth, planes, tell):
    """`colours` of 8 bits, three or one; `depth` in plane numbers."""
    size = view_size(colours.shape[1], colours.shape[0])
    code = nearest(results.code_of(depth, 0, planes - 1), size)
    views = views_of(np.ascontiguousarray(np.broadcast_to(shrunk(colours, size), (size[1], size[0], 3))), code, tell)
    numbers = rocking()
    description = (f'{engine.SOURCE} ! videoconvert ! vp8enc deadline=1 target-bitrate=4000000 ! webmmux ! '
                   f'filesink location={engine.quoted(path)}')
    with engine.running(description, tell) as run:
        run.play([engine.stack_buffer([np.ascontiguousarray(views[k])], 1, COLOURS, *size) for k in numbers],
                 f'video/x-raw,format=RGB,width={size[0]},height={size[1]},framerate={FRAMES_A_SECOND}/1', FRAMES_A_SECOND)
