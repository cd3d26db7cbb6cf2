#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Receives depth from dff-rtsp-server and prints each frame's distances in millimetres.

    receive.py rtsp://HOST:8554/depth [FRAMES]
    receive.py rtsp://HOST:8554/hue [FRAMES]

The SDP says what the pixels mean, rtspsrc puts that into its caps as a-depth-..., and here it becomes the caps fields
depth-unit, depth-near and depth-far again, for depthuncolorize, depthcolorize, depthplyenc and their kin behind it.
"""
import sys
import time

import gi
import numpy as np

gi.require_version('Gst', '1.0')
gi.require_version('GstApp', '1.0')
from gi.repository import GLib, Gst, GstApp  # noqa: E402, F401

SECONDS = 30  # without a frame, after which it gives up
DECODERS = {
    'JPEG2000': 'rtpj2kdepay ! jpeg2000parse ! avdec_jpeg2000',
    'H264': 'rtph264depay ! avdec_h264 ! videoconvert ! depthuncolorize near={near} far={far}',
}


class DepthStream:
    """Depth frames of an RTSP URL, in millimetres."""

    def __init__(self, url):
        self.pipeline = Gst.Pipeline()
        self.source = Gst.ElementFactory.make('rtspsrc')
        self.source.set_property('location', url)
        self.source.set_property('latency', 200)  # milliseconds that packets may be late
        self.sink = Gst.ElementFactory.make('appsink')
        self.sink.set_property('sync', False)
        self.sink.set_property('max-buffers', 8)
        for element in (self.source, self.sink):
            self.pipeline.add(element)
        self.source.connect('pad-added', self.link)
        self.source.connect('no-more-pads', self.look_for_depth)
        self.facts = {}
        self.pipeline.set_state(Gst.State.PLAYING)

    def link(self, _, pad):
        rtp = pad.get_current_caps().get_structure(0)
        names = [rtp.nth_field_name(i) for i in range(rtp.n_fields())]
        facts = {name[len('a-depth-'):]: rtp.get_string(name) for name in names if name.startswith('a-depth-')}
        if 'unit' not in facts:
            return self.drop(pad)  # the colour of /stream
        self.facts = facts
        restored = f'video/x-raw,depth-unit=(string){facts["unit"]}'
        if 'near' in facts:
            restored += f',depth-near=(double){facts["near"]},depth-far=(double){facts["far"]}'
        decoder = DECODERS[rtp.get_string('encoding-name')].format(**facts)
        receiver = Gst.parse_bin_from_description(f'{decoder} ! videoconvert ! capssetter caps="{restored}"', True)
        self.pipeline.add(receiver)
        receiver.link(self.sink)
        receiver.sync_state_with_parent()
        pad.link(receiver.get_static_pad('sink'))

    def drop(self, pad):
        sink = Gst.ElementFactory.make('fakesink')
        sink.set_property('async', False)
        self.pipeline.add(sink)
        sink.sync_state_with_parent()
        pad.link(sink.get_static_pad('sink'))

    def look_for_depth(self, source):
        if not self.facts:
            error = GLib.Error.new_literal(Gst.StreamError.quark(), f'There is no depth at {source.get_property("location")}',
                                           Gst.StreamError.WRONG_TYPE)
            self.pipeline.get_bus().post(Gst.Message.new_error(source, error, 'a-depth-unit is missing from its SDP'))

    def millimetres(self, pixels):
        """Distances from the camera; NAN where the depth is not known. inf is as far as can be."""
        value = float(self.facts['offset']) + float(self.facts['scale']) * pixels
        with np.errstate(divide='ignore'):
            distance = {'dioptre': lambda: 1000.0 / np.maximum(value, 0.0), 'millimetre': lambda: value,
                        'micrometre': lambda: value / 1000.0}[self.facts['unit']]()
        return np.where(pixels == 0, np.nan, distance)

    def next_sample(self):
        """None at the end of the stream. Ends with what the bus says, which a source that cannot start says at once."""
        bus, end = self.pipeline.get_bus(), time.monotonic() + SECONDS
        while time.monotonic() < end:
            if sample := self.sink.try_pull_sample(Gst.SECOND // 10):
                return sample
            if message := bus.pop_filtered(Gst.MessageType.ERROR):
                error, details = message.parse_error()
                raise SystemExit(f'{error.message} ({details})')
            if self.sink.is_eos():
                return None
        raise SystemExit(f'No frame came in {SECONDS} s')

    def __iter__(self):
        while sample := self.next_sample():
            caps, buffer = sample.get_caps().get_structure(0), sample.get_buffer()
            data = buffer.extract_dup(0, buffer.get_size())
            width, height = caps.get_value('width'), caps.get_value('height')
            stride = len(data) // height // 2
            yield buffer.pts, self.millimetres(np.frombuffer(data, '<u2').reshape(height, stride)[:, :width])

    def close(self):
        self.pipeline.set_state(Gst.State.NULL)


def main(url, frames='10'):
    Gst.init(None)
    stream = DepthStream(url)
    try:
        for number, (time_ns, depth) in enumerate(stream, 1):
            middle = depth[depth.shape[0] // 2, depth.shape[1] // 2]
            known = depth[np.isfinite(depth)]
            nearest = known.min() if known.size else np.nan
            print(f'{time_ns / Gst.SECOND:8.3f} s  nearest {nearest:7.0f} mm  middle {middle:7.0f} mm', flush=True)
            if number == int(frames):
                break
    finally:
        stream.close()


if __name__ == '__main__':
    main(*sys.argv[1:])
