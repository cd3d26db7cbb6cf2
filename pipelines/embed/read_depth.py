#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Prints how far away the middle of each depth frame is."""
import sys

import gi

gi.require_version('Gst', '1.0')
gi.require_version('GstApp', '1.0')
gi.require_version('GstDff', '1.0')
gi.require_version('GstVideo', '1.0')
from gi.repository import Gst, GstApp, GstDff, GstVideo  # noqa: E402, F401  GstApp gives appsink its methods
import numpy as np  # noqa: E402


def metres(sample):
    """The depth frame as an array of metres; NaN where nothing is known."""
    buffer = sample.get_buffer()
    meta = GstDff.buffer_get_depth_meta(buffer)
    info = GstVideo.VideoInfo.new_from_caps(sample.get_caps())
    data = np.frombuffer(buffer.extract_dup(0, buffer.get_size()), '<u2')
    pixels = data.reshape(info.height, info.stride[0] // 2)[:, :info.width]
    dioptres = meta.offset + meta.scale * pixels
    return meta.sweep, np.where((pixels == 0) | (dioptres <= 0), np.nan, 1 / np.maximum(dioptres, 1e-9))


def next_sample(sink, bus):
    """The next sample, None at the end of the stream. Ends with what the bus says: who waits without looking there waits for
    ever for a source that cannot start."""
    while True:
        if sample := sink.try_pull_sample(Gst.SECOND // 10):
            return sample
        if failure := bus.pop_filtered(Gst.MessageType.ERROR):
            error, details = failure.parse_error()
            sys.exit(f'{error.message} ({details})')
        if sink.is_eos():
            return None


def main():
    Gst.init(None)
    pipeline = Gst.parse_launch('lenssweeptestsrc num-buffers=60 near=5 far=0.5 ! focalstackmux ! '
                                'dffdepth unit=dioptre ! appsink name=depth sync=false')
    sink, bus = pipeline.get_by_name('depth'), pipeline.get_bus()
    try:
        started = pipeline.set_state(Gst.State.PLAYING)
        while sample := next_sample(sink, bus):
            sweep, depth = metres(sample)
            print(f'sweep {sweep}: {depth[depth.shape[0] // 2, depth.shape[1] // 2]:.3f} m')
        if started == Gst.StateChangeReturn.FAILURE:
            sys.exit('The pipeline does not start')
    finally:
        pipeline.set_state(Gst.State.NULL)


if __name__ == '__main__':
    main()
