# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Frames and counts in rerun's words.

    camera                 the pinhole, where the intrinsics are known
    camera/picture         the all-in-focus picture, as JPEG
    camera/depth           metres; or, where nobody knows metres, plane numbers as a picture without a scale
    camera/confidence      0 to 255
    pace/...               stacks a second, and seconds from the first exposure to depth
    counts/..., times/...  what the elements' stats tell, milliseconds apart from the rest
    log                    what happened
"""
import logging
import math
import time

import numpy as np
import rerun as rr
from gi.repository import Gst
from rerun import blueprint as rrb

from dff_studio import Unusable, controls
from dff_studio.frames import Depth, Frames, pixels_of
from dff_studio.source import running_time

log = logging.getLogger('dff-rerun')


def layout():
    pictures = [rrb.Spatial2DView(origin=f'camera/{name}', name=name) for name in ('picture', 'depth', 'confidence')]
    plots = [rrb.TimeSeriesView(origin=name, name=name) for name in ('pace', 'counts', 'times')]
    return rrb.Blueprint(rrb.Horizontal(rrb.Spatial3DView(origin='/', name='points'), rrb.Vertical(*pictures, rrb.Tabs(*plots))),
                         collapse_panels=True)


def open_stream(url, path):
    try:
        sinks = [rr.GrpcSink(url)] if url else []
        if path:
            with open(path, 'wb'):  # fails before there is anything to be lost
                sinks.append(rr.FileSink(path))
        stream = rr.RecordingStream('gst-plugins-dff')
        stream.set_sinks(*sinks, default_blueprint=layout())
    except (OSError, RuntimeError, ValueError) as error:
        raise Unusable(f'Nothing can be handed to {path or url}: {error}') from None
    return stream


def pinhole_of(depth, width, height):
    """Rerun's pixels begin at the corner of the first one, those of the intrinsics in its middle."""
    fx, fy, cx, cy = depth.intrinsics
    return rr.Pinhole(focal_length=(fx, fy), principal_point=(cx + 0.5, cy + 0.5), resolution=(width, height),
                      camera_xyz=rr.ViewCoordinates.RDF)


def range_of(depth):
    """The sweep's ends in metres, so that colours keep their meaning; None where one is not known or infinitely far."""
    if depth.unit in ('dioptre', 'millimetre') and math.isfinite(depth.near - depth.far) and depth.far > 0:
        return 1 / depth.near, 1 / depth.far
    return None


def what_is_missing(depth):
    """In words; empty where depth has metres and a camera."""
    if depth.unit not in ('dioptre', 'millimetre', 'micrometre'):
        return ('Depth is in plane numbers, and no metres are made up: it is shown as a picture. Give near and far to the source, '
                'or a calibration to dffdepth')
    if depth.unit == 'micrometre':
        return 'Depth is the height of a microscope\'s stage, without a pinhole: it is shown flat'
    if not depth.intrinsics:
        return 'The camera is not known: depth is in metres, without points in space. Give calibration= to dffdepth'
    return ''


class Recording:
    """`take_sample` is called by streaming threads, the rest by the main loop."""

    def __init__(self, url, path):
        self.stream = open_stream(url, path)
        self.source = None
        self.frames = Frames()
        self.camera = self.missing = None
        # Of the clock that pipelines run by, which does not go back when a source is started again.
        self.epoch = time.time_ns() - Gst.SystemClock.obtain().get_time()
        self.take = {'depth': self.take_depth, 'aif': self.take_picture, 'confidence': self.take_confidence}

    def set_time(self, nanoseconds):
        """Of what the calling thread logs from here on: that of the first exposure, the same for all of a stack."""
        self.stream.set_time('time', timestamp=np.datetime64(self.epoch + nanoseconds, 'ns'))

    def take_sample(self, output, sample, age):
        running = running_time(sample)
        if running is None or output not in self.take:
            return
        self.frames.put(output, sample, age)
        self.set_time(self.source.pipeline.get_base_time() + running)
        self.take[output](sample)

    def take_depth(self, sample):
        depth = Depth.of(sample)
        values = depth.values(depth.pixels())
        self.tell_what_is_missing(depth)
        if depth.unit not in ('dioptre', 'millimetre', 'micrometre'):
            return self.stream.log('camera/depth', rr.Image(np.nan_to_num(values, nan=-1).astype(np.float32)))
        self.place_camera(depth, values.shape)
        metres = np.nan_to_num(depth.metres(values), nan=0, posinf=np.inf).astype(np.float32)  # rerun takes 0 for not known
        self.stream.log('camera/depth', rr.DepthImage(metres, meter=1.0, colormap='turbo', depth_range=range_of(depth)))

    def place_camera(self, depth, shape):
        camera = (depth.intrinsics, shape)
        if depth.intrinsics and depth.unit != 'micrometre' and camera != self.camera:
            self.camera = camera
            self.stream.log('camera', pinhole_of(depth, shape[1], shape[0]))

    def tell_what_is_missing(self, depth):
        missing = what_is_missing(depth)
        if missing != self.missing:
            self.missing = missing
            if missing:
                log.warning('%s', missing)
                self.stream.log('log', rr.TextLog(missing, level=rr.TextLogLevel.WARN))

    def take_picture(self, sample):
        buffer = sample.get_buffer()
        self.stream.log('camera/picture', rr.EncodedImage(contents=buffer.extract_dup(0, buffer.get_size()), media_type='image/jpeg'))

    def take_confidence(self, sample):
        self.stream.log('camera/confidence', rr.Image(pixels_of(sample.get_buffer(), sample.get_caps(), 'u1'), color_model='L'))

    def take_state(self, text):
        if text:
            self.stream.log('log', rr.TextLog(text, level=rr.TextLogLevel.WARN))

    def plot(self):
        """What the elements count, as of now; called every second."""
        self.set_time(Gst.SystemClock.obtain().get_time())
        rate, age = self.frames.pace()
        self.stream.log('pace/stacks-per-second', rr.Scalars(rate))
        if age is not None:
            self.stream.log('pace/latency', rr.Scalars(age))
        for element, counts in controls.stats(self.source.pipeline).items():
            for name, value in counts.items():
                if value is not None:
                    self.stream.log(f'{"times" if name.endswith("-ms") else "counts"}/{element}/{name}', rr.Scalars(float(value)))
        return True

    def end(self):
        self.stream.disconnect()
