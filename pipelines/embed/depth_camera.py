#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""All-in-focus pictures, depth in millimetres and what is known of both, as arrays; from one source after the other:

depth_camera.py                                   a simulated camera
depth_camera.py "lenssweepsrc lens=... planes=6"  a real one
depth_camera.py "lenssweeptestsrc num-buffers=60" "lenssweepsrc num-buffers=600"
"""
import sys

import gi

gi.require_version('Gst', '1.0')
gi.require_version('GstApp', '1.0')
gi.require_version('GstDff', '1.0')
gi.require_version('GstVideo', '1.0')
from gi.repository import Gst, GstApp, GstDff, GstVideo  # noqa: E402, F401  GstApp gives appsink its methods
import numpy as np  # noqa: E402


def pixels(sample, dtype, channels):
    """The picture of a sample as an array of height x width x channels."""
    info = GstVideo.VideoInfo.new_from_caps(sample.get_caps())
    buffer = sample.get_buffer()
    rows = np.frombuffer(buffer.extract_dup(0, buffer.get_size()), np.uint8).reshape(info.height, info.stride[0])
    packed = np.ascontiguousarray(rows[:, :info.width * channels * np.dtype(dtype).itemsize])
    return packed.view(dtype).reshape(info.height, info.width, channels)


class Failure(Exception):
    """What a pipeline said of its end."""


def next_sample(sink, bus):
    """The next sample, None at the end of the stream. Raises what the bus says: who waits without looking there waits for
    ever for a source that cannot start."""
    while True:
        if sample := sink.try_pull_sample(Gst.SECOND // 10):
            return sample
        if failure := bus.pop_filtered(Gst.MessageType.ERROR):
            error, details = failure.parse_error()
            raise Failure(f'{error.message} ({details})')
        if sink.is_eos():
            return None


def frames(pipeline):
    """Each depth map in millimetres (0 is unknown), its meta, and its picture in RGB."""
    depth_sink, aif_sink, bus = pipeline.get_by_name('depth'), pipeline.get_by_name('aif'), pipeline.get_bus()
    while (depth := next_sample(depth_sink, bus)) and (aif := next_sample(aif_sink, bus)):
        yield pixels(depth, '<u2', 1)[:, :, 0], GstDff.buffer_get_depth_meta(depth.get_buffer()), pixels(aif, 'u1', 3)


def main():
    Gst.init(None)
    pipeline = Gst.parse_launch(
        'dffcamerabin name=camera unit=millimetre  camera.depth ! appsink name=depth sync=false max-buffers=2 '
        'camera.aif ! videoconvert ! video/x-raw,format=RGB ! appsink name=aif sync=false max-buffers=2')
    camera = pipeline.get_by_name('camera')

    for source in sys.argv[1:] or ['lenssweeptestsrc num-buffers=60 near=5 far=0.5']:
        camera.props.source = source
        try:
            started = pipeline.set_state(Gst.State.PLAYING)
            for count, (millimetres, meta, picture) in enumerate(frames(pipeline)):
                middle = millimetres.shape[0] // 2, millimetres.shape[1] // 2
                print(f'sweep {meta.sweep} of {meta.near:g} to {meta.far:g} dioptres: {millimetres[middle]} mm, '
                      f'colour {picture[middle][0]} {picture[middle][1]} {picture[middle][2]}')
                if count == 2:  # any property of dffdepth and aifcompose can change while it runs
                    Gst.util_set_object_arg(camera, 'blend', 'sharp')
            if started == Gst.StateChangeReturn.FAILURE:
                raise Failure(f'The source does not start: {source}')
        finally:
            pipeline.set_state(Gst.State.NULL)


if __name__ == '__main__':
    try:
        main()
    except Failure as failure:
        sys.exit(str(failure))
