#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What H.264 and H.265 leave of depth in the colours of depthcolorize palette=hue.

    hue_codecs.py               the figures, as a table in Markdown
    hue_codecs.py PICTURE.svg   and as a plot, with Matplotlib

The depth is the truth of a simulated scene in motion, with holes, 640x480 at 26 frames/s. Beside our colours stand those of
Sonoda and Grunnet-Jepsen, "Depth image compression by colorization for Intel RealSense Depth Cameras" (rev. 1.0, 2020), with
their formulas for both ways: six edges of the colour cube, 1529 steps. Each pixel counts in one of three ways: known on both
sides, which gives an error; a hole that is filled or a known pixel that is lost; a hole on both sides.
"""
import sys

import gi

gi.require_version('Gst', '1.0')
gi.require_version('GstApp', '1.0')
from gi.repository import Gst, GstApp  # noqa: E402, F401  GstApp gives appsink its methods
import numpy as np  # noqa: E402

NEAR, FAR = 5.0, 0.5  # dioptres
WIDTH, HEIGHT, RATE = 640, 480, 26
BIT_RATES = (500, 1000, 2000, 4000, 8000)  # kbit/s that the encoder is asked for
CODECS = {
    'H.264': 'x264enc bitrate={rate} speed-preset=medium ! h264parse ! identity name=size ! avdec_h264',
    'H.265': 'x265enc bitrate={rate} speed-preset=fast log-level=none ! h265parse ! identity name=size ! avdec_h265',
}


class OurHue:
    caps = f'video/x-raw,format=GRAY16_LE,depth-unit=dioptre,depth-near={NEAR},depth-far={FAR}'
    before = 'depthcolorize palette=hue !'
    after = f'! depthuncolorize near={NEAR} far={FAR}'

    @staticmethod
    def encode(depth):
        return depth.astype('<u2').tobytes()

    @staticmethod
    def decode(data):
        return np.frombuffer(data, '<u2').reshape(HEIGHT, WIDTH)


class PublishedHue:
    """The white paper's formulas, on the same positions between near and far."""
    caps, before, after = 'video/x-raw,format=RGB', '', ''

    @staticmethod
    def encode(depth):
        d = np.round((depth.astype(float) - 1) / 65534 * 1529).astype(int)
        corners = np.arange(7) * 255
        red = np.interp(d, corners, [255, 255, 0, 0, 0, 255, 255])
        green = np.interp(d, corners, [0, 255, 255, 255, 0, 0, 0])
        blue = np.interp(d, corners, [0, 0, 0, 255, 255, 255, 0])
        return np.where((depth == 0)[..., None], 0, np.stack([red, green, blue], -1)).astype(np.uint8).tobytes()

    @staticmethod
    def decode(data):
        r, g, b = np.moveaxis(np.frombuffer(data, np.uint8).reshape(HEIGHT, WIDTH, 3).astype(int), -1, 0)
        d = np.where((b >= g) & (b >= r), r - g + 1020, 0)
        d = np.where((g >= r) & (g >= b), b - r + 510, d)
        d = np.where((r >= g) & (r >= b), np.where(g >= b, g - b, g - b + 1529), d)
        return np.where(r + g + b < 128, 0, 1 + np.clip(d, 0, 1529) / 1529 * 65534)


def pull_all(sink):
    while sample := sink.pull_sample():
        buffer = sample.get_buffer()
        yield buffer.extract_dup(0, buffer.get_size())


def scene(frames):
    """True depth, with round holes that wander."""
    pipeline = Gst.parse_launch(
        f'lenssweeptestsrc name=c num-buffers={frames} planes=6 rate=4 near={NEAR} far={FAR} motion=2 '
        f'c.src ! video/x-raw,width={WIDTH},height={HEIGHT} ! queue ! fakesink '
        'c.depth ! queue max-size-time=0 max-size-bytes=0 ! appsink name=out sync=false')
    pipeline.set_state(Gst.State.PLAYING)
    random = np.random.default_rng(1)
    centre, step = random.uniform(0, [HEIGHT, WIDTH], (25, 2)), random.normal(0, 2, (25, 2))
    radius = random.uniform(3, 25, 25)
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    result = []
    for data in pull_all(pipeline.get_by_name('out')):
        depth = np.frombuffer(data, '<u2').reshape(HEIGHT, WIDTH).copy()
        for (cy, cx), r in zip(centre, radius):
            depth[(y - cy)**2 + (x - cx)**2 < r * r] = 0
        centre += step
        result.append(depth)
    pipeline.set_state(Gst.State.NULL)
    return result


def through(codec, rate, colours, frames):
    """The frames after the codec, and its kbit/s."""
    size = f'width={WIDTH},height={HEIGHT},framerate={RATE}/1'
    pipeline = Gst.parse_launch(
        f'appsrc name=in format=time caps={colours.caps},{size} ! {colours.before} videoconvert ! video/x-raw,format=I420 ! '
        f'{CODECS[codec].format(rate=rate)} ! videoconvert ! video/x-raw,format=RGB {colours.after} ! '
        'appsink name=out sync=false')
    sizes = []
    pipeline.get_by_name('size').connect('handoff', lambda _, buffer: sizes.append(buffer.get_size()))
    pipeline.set_state(Gst.State.PLAYING)
    source = pipeline.get_by_name('in')
    for k, depth in enumerate(frames):
        buffer = Gst.Buffer.new_wrapped(colours.encode(depth))
        buffer.pts, buffer.duration = k * Gst.SECOND // RATE, Gst.SECOND // RATE
        source.push_buffer(buffer)
    source.end_of_stream()
    result = [colours.decode(data) for data in pull_all(pipeline.get_by_name('out'))]
    pipeline.set_state(Gst.State.NULL)
    return result, sum(sizes) * 8 * RATE / len(frames) / 1000


def dioptres(pixels):
    return NEAR - (np.asarray(pixels, float) - 1) / 65534 * (NEAR - FAR)


def measure(before, after):
    before, after = np.stack(before), np.stack(after)
    known = (before > 0) & (after > 0)
    error = np.abs(dioptres(after[known]) - dioptres(before[known]))
    millimetres = np.abs(1000 / dioptres(after[known]) - 1000 / dioptres(before[known]))
    return {
        'median D': np.median(error), '95 % D': np.percentile(error, 95), '99 % D': np.percentile(error, 99),
        'mean D': error.mean(), 'median mm': np.median(millimetres), '95 % mm': np.percentile(millimetres, 95),
        'off by 1 D, %': 100 * np.mean(error > 1), 'holes wrong, %': 100 * np.mean((before > 0) != (after > 0)),
    }


def load_pyplot():
    """To be called before GStreamer loads its plug-ins, whose libraries Matplotlib's do not bear."""
    import matplotlib
    matplotlib.use('svg')
    import matplotlib.pyplot
    return matplotlib.pyplot


def plot(plt, rows, picture):
    figure, axes = plt.subplots(2, 3, figsize=(12, 8))
    axes = axes.flat
    for axis, column in zip(axes, ('median D', '95 % D', 'off by 1 D, %', 'median mm', '95 % mm', 'holes wrong, %')):
        for codec in CODECS:
            for colours, line in ((OurHue, '-o'), (PublishedHue, ':x')):
                points = [(rate, row[column]) for c, k, rate, row in rows if c == codec and k is colours]
                axis.plot(*zip(*points), line, label=f'{codec}, {"hue" if colours is OurHue else "published hue"}')
        axis.set(xlabel='kbit/s', ylabel=column, xscale='log', yscale='log')
        axis.grid(True, which='both', alpha=0.3)
    axes[0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture)


def main():
    plt = load_pyplot() if len(sys.argv) > 1 else None
    Gst.init(None)
    frames = scene(52)
    rows = []
    for codec in CODECS:
        for asked in BIT_RATES:
            for colours in (OurHue, PublishedHue):
                after, rate = through(codec, asked, colours, frames)
                rows.append((codec, colours, rate, measure(frames, after)))
    print('| codec | colours | kbit/s |', ' | '.join(rows[0][3]), '|')
    print('|---|---|' + '---:|' * (1 + len(rows[0][3])))
    for codec, colours, rate, row in rows:
        print(f'| {codec} | {"hue" if colours is OurHue else "published"} | {rate:.0f} |',
              ' | '.join(f'{value:.3g}' for value in row.values()), '|')
    if plt:
        plot(plt, rows, sys.argv[1])


if __name__ == '__main__':
    main()
