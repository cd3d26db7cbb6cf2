# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Frames as files, and the video as it goes by as a recording: made by elements."""
import os
import tempfile
import time

from gi.repository import Gst

from dff_studio import Unusable
from dff_studio.video import TRACKS

PATIENCE = 30  # seconds for a file
SOURCE = 'appsrc name={0} format=time'
SINK = 'appsink name=file sync=false'
JPEG = f'{SOURCE.format("aif")} ! videoconvert ! jpegenc quality={{quality}} ! {SINK}'
MAKE = {
    'png': f'{SOURCE.format("aif")} ! videoconvert ! pngenc ! {SINK}',
    'depth.png': f'{SOURCE.format("depth")} ! videoconvert ! video/x-raw,format=GRAY16_BE ! pngenc ! {SINK}',
    'exr': (f'{SOURCE.format("aif")} ! videoconvert ! queue ! e.color  {SOURCE.format("depth")} ! queue ! e.depth  '
            f'depthexrenc name=e ! {SINK}'),
    'ply': (f'{SOURCE.format("aif")} ! videoconvert ! queue ! e.color  {SOURCE.format("depth")} ! queue ! e.depth  '
            f'depthplyenc name=e projection={{projection}} ! {SINK}'),
}
MOST_BYTES = 4 << 30  # of a recording
MOST_SECONDS = 1800


def make(description, samples):
    """The bytes of a file, of one sample for each source. Blocks."""
    try:
        pipeline = Gst.parse_launch(description)
    except Exception as error:
        raise Unusable(f'This cannot be saved: {error}') from None
    try:
        pipeline.set_state(Gst.State.PLAYING)
        for name, sample in samples.items():
            if source := pipeline.get_by_name(name):
                buffer = sample.get_buffer().copy()
                buffer.pts, buffer.dts, buffer.duration = 0, Gst.CLOCK_TIME_NONE, Gst.SECOND
                source.set_property('caps', sample.get_caps())
                source.emit('push-buffer', buffer)
                source.emit('end-of-stream')
        return collected(pipeline)
    finally:
        pipeline.set_state(Gst.State.NULL)


def collected(pipeline):
    sink, bus, parts, end = pipeline.get_by_name('file'), pipeline.get_bus(), [], time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if sample := sink.emit('try-pull-sample', Gst.SECOND // 20):
            buffer = sample.get_buffer()
            parts.append(buffer.extract_dup(0, buffer.get_size()))
        elif message := bus.pop_filtered(Gst.MessageType.ERROR):
            raise Unusable(message.parse_error()[0].message)
        elif sink.get_property('eos'):
            if not parts:
                raise Unusable('Nothing was saved: the frame holds no depth')
            return b''.join(parts)
    raise Unusable(f'This was not saved within {PATIENCE} s')


def jpeg(sample, quality=85):
    return make(JPEG.format(quality=quality), {'aif': sample})


def file_of(kind, picture, depth):
    """png, depth.png, exr or ply of a frozen frame."""
    samples = {'aif': picture, 'depth': depth.sample if depth else None}
    wanted = {'png': ['aif'], 'depth.png': ['depth']}.get(kind, ['aif', 'depth'])
    for name in wanted:
        if samples[name] is None:
            raise Unusable(f'The source gives no {"picture" if name == "aif" else "depth"} to save')
    projection = 'orthographic' if depth and depth.unit == 'micrometre' else 'perspective'
    return make(MAKE[kind].format(projection=projection), {name: samples[name] for name in wanted})


class Recording:
    """The two videos, as they are encoded anyway, to one Matroska file: the picture, and depth in hues, which depthuncolorize
    undoes."""

    def __init__(self, video, depth):
        self.video = video
        handle, self.path = tempfile.mkstemp(prefix='dff-studio-', suffix='.mkv')
        os.close(handle)
        self.started = time.monotonic()
        self.title = f'depth in hues: near={depth.near:g} far={depth.far:g} unit={depth.unit}' if depth else 'picture'
        self.pipeline = Gst.parse_launch(
            'matroskamux name=mux min-cluster-duration=1000000000 ! filesink name=file  '
            + ' '.join(f'appsrc name={track} is-live=true format=time max-bytes=8000000 ! queue ! rtpvp8depay ! mux.' for track in TRACKS))
        self.pipeline.get_by_name('file').set_property('location', self.path)
        tags = Gst.TagList.new_empty()
        tags.add_value(Gst.TagMergeMode.REPLACE, Gst.TAG_TITLE, self.title)
        self.pipeline.get_by_name('mux').merge_tags(tags, Gst.TagMergeMode.REPLACE)
        self.taps = [self.tap(track) for track in TRACKS]
        self.pipeline.set_state(Gst.State.PLAYING)
        video.ask_for_whole_picture()

    def tap(self, track):
        """The packets of a track on their way to the viewers, from now on."""
        source = self.pipeline.get_by_name(track)
        pad = self.video.pipeline.get_by_name(f'{track}-tee').get_static_pad('sink')
        source.set_property('caps', pad.get_current_caps())
        first = []

        def take(_, info):
            buffer = info.get_buffer().copy()
            first.append(buffer.pts) if not first else None
            buffer.pts -= first[0]
            buffer.dts = Gst.CLOCK_TIME_NONE
            source.emit('push-buffer', buffer)
            return Gst.PadProbeReturn.OK
        return pad, pad.add_probe(Gst.PadProbeType.BUFFER, take), source

    def is_full(self):
        return os.path.getsize(self.path) > MOST_BYTES or time.monotonic() - self.started > MOST_SECONDS

    def finish(self):
        """Blocks until the file is whole."""
        for pad, probe, source in self.taps:
            pad.remove_probe(probe)
            source.emit('end-of-stream')
        message = self.pipeline.get_bus().timed_pop_filtered(PATIENCE * Gst.SECOND, Gst.MessageType.EOS | Gst.MessageType.ERROR)
        self.pipeline.set_state(Gst.State.NULL)
        if message is None or message.type == Gst.MessageType.ERROR:
            raise Unusable('The recording did not end well' if message is None else message.parse_error()[0].message)

    def forget(self):
        self.pipeline.set_state(Gst.State.NULL)
        if os.path.exists(self.path):
            os.unlink(self.path)
