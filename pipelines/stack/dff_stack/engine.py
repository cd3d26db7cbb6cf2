# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The elements at work: a stack that fits into memory to its picture, depth and confidence, and to how its planes lie."""
import contextlib
import dataclasses

import gi
import numpy as np

gi.require_version('Gst', '1.0')
from gi.repository import Gst  # noqa: E402

from dff_stack import Unusable, memory, one_line  # noqa: E402
from dff_stack.encoding import Encoding  # noqa: E402

LUMA, DEPTH = Encoding('GRAY8', 1, 'u1', False), Encoding('GRAY16_LE', 1, '<u2', False)
abandoned = []  # runs that were interrupted, which must not be freed
COPIED_BYTES = 128 * 1024  # at once: the copies on the way then stay in the processor's cache
TICK_NS = 100 * 1000 * 1000  # between two looks at the keyboard
ELEMENTS = ('appsrc', 'appsink', 'focalstackalign', 'dffdepth', 'aifcompose')


@dataclasses.dataclass
class Solved:
    """What is known of a stack: its picture in the stack's own samples, plane numbers (NaN = not known), 0..255 of confidence."""
    picture: np.ndarray
    depth: np.ndarray
    confidence: np.ndarray


def start():
    memory.use_sparingly()
    Gst.init(None)
    missing = [name for name in ELEMENTS if not Gst.ElementFactory.find(name)]
    if missing:
        raise Unusable(f'GStreamer has no element {missing[0]}: install the plug-ins, or run this in `meson devenv -C build`')


def takes(fields):
    """Whether the elements take stacks with such caps fields."""
    caps = Gst.Caps.from_string(f'video/x-focal-stack,{fields}')
    return all(any(template.get_caps().can_intersect(caps) for template in Gst.ElementFactory.find(name).get_static_pad_templates())
               for name in ('focalstackalign', 'dffdepth', 'aifcompose'))


def has_deep_colour():
    """Whether the elements take 16 bits a colour."""
    return takes('format=RGBA64_LE')


def most_side():
    """Pixels that a picture may have in each direction."""
    return next((side for side in (16384, 8192) if takes(f'width={side},height={side}')), 8192)


def stack_buffer(planes, count, encoding, width, height):
    """One buffer with all planes, one after the other; `planes` gives them one at a time."""
    stride = encoding.stride(width)
    buffer = Gst.Buffer.new_allocate(None, count * stride * height, None)
    if buffer is None:
        raise Unusable(f'There is no memory for {count} pictures of {width}x{height} at once: lower --memory')
    at_once = max(1, COPIED_BYTES // stride)
    for number, plane in enumerate(planes):
        rows = np.ascontiguousarray(plane).reshape(height, -1).view(np.uint8)
        for first in range(0, height, at_once):
            part = rows[first:first + at_once]
            if part.shape[1] != stride:
                part = np.pad(part, ((0, 0), (0, stride - part.shape[1])))
            buffer.fill((number * height + first) * stride, part.tobytes())
    return buffer


def array_of(sample, kind, channels):
    """Rows, columns and channels of a frame."""
    structure = sample.get_caps().get_structure(0)
    width, height = structure.get_value('width'), structure.get_value('height')
    data = np.frombuffer(sample.get_buffer().extract_dup(0, sample.get_buffer().get_size()), np.uint8)
    row = width * channels * np.dtype(kind).itemsize
    rows = data.reshape(height, len(data) // height)[:, :row]
    return np.ascontiguousarray(rows).view(kind).reshape(height, width, channels)


class Run:
    """A pipeline that gets one buffer and gives one from each of its sinks."""

    def __init__(self, description, tell):
        self.tell = tell
        self.pipeline = Gst.parse_launch(description)
        self.bus = self.pipeline.get_bus()

    def element(self, name):
        return self.pipeline.get_by_name(name)

    def push(self, name, buffer, caps):
        """The only buffer of a source."""
        source = self.element(name)
        source.set_property('caps', Gst.Caps.from_string(caps))
        source.emit('push-buffer', buffer)
        source.emit('end-of-stream')

    def look(self, wait_ns=0):
        """Raises what has failed; tells warnings and progress. Returns whether the end was reached."""
        wanted = Gst.MessageType.ERROR | Gst.MessageType.WARNING | Gst.MessageType.PROGRESS | Gst.MessageType.EOS
        message = self.bus.timed_pop_filtered(wait_ns, wanted)
        if message is None or message.type == Gst.MessageType.EOS:
            return message is not None
        if message.type == Gst.MessageType.ERROR:
            raise Unusable(one_line(message.parse_error()[0].message))
        if message.type == Gst.MessageType.WARNING:
            self.tell(one_line(message.parse_warning()[0].message))
        else:
            kind, _, text = message.parse_progress()
            if kind == Gst.ProgressType.START:
                self.tell(one_line(text))
        return False

    def results(self, buffer, caps, sinks):
        """One sample of each of the sinks."""
        self.pipeline.set_state(Gst.State.PLAYING)
        self.push('source', buffer, caps)
        del buffer
        found = {}
        while len(found) < len(sinks):
            self.look()
            for name in sinks:
                if name not in found:
                    sample = self.element(name).emit('try-pull-sample', TICK_NS)
                    if sample:
                        found[name] = sample
                    elif self.element(name).get_property('eos'):
                        self.look(10 * TICK_NS)
                        raise Unusable('the elements gave no result and did not say why')
        while self.bus.have_pending():
            self.look()
        return [found[name] for name in sinks]

    def play(self, buffers, caps, rate):
        """Frames of so many a second, to the end."""
        source = self.element('source')
        source.set_property('caps', Gst.Caps.from_string(caps))
        self.pipeline.set_state(Gst.State.PLAYING)
        for number, buffer in enumerate(buffers):
            buffer.pts, buffer.duration = number * Gst.SECOND // rate, Gst.SECOND // rate
            source.emit('push-buffer', buffer)
        source.emit('end-of-stream')
        while not self.look(TICK_NS):
            pass


def is_interrupt(error):
    """Python makes a SystemError of an interrupt that comes inside a call of GStreamer's."""
    return isinstance(error, KeyboardInterrupt) or (isinstance(error, SystemError) and isinstance(error.__cause__, KeyboardInterrupt))


@contextlib.contextmanager
def running(description, tell):
    run = Run(description, tell)
    try:
        yield run
    except BaseException as error:
        if is_interrupt(error):
            abandoned.append(run)  # to stop it would be to wait for it
            raise KeyboardInterrupt from error
        run.pipeline.set_state(Gst.State.NULL)
        raise
    run.pipeline.set_state(Gst.State.NULL)
    memory.give_back()


def caps_of(encoding, width, height, planes):
    return (f'video/x-focal-stack,format={encoding.format},width={width},height={height},planes={planes},framerate=1/1')


SOURCE = 'appsrc name=source format=time max-bytes=0'


def sink(name):
    return f'queue ! appsink name={name} sync=false'


def quoted(text):
    """As a value of a pipeline's description."""
    return '"' + str(text).replace('\\', '\\\\').replace('"', '\\"') + '"'


def solve(planes, count, encoding, size, calibration, work):
    """Depth and the picture of a stack. `calibration` is a file with the planes' warps, or None where they lie as they should."""
    width, height = size
    align = ''
    if calibration:
        align = f'! focalstackalign mode=calibration calibration={quoted(calibration)} even-brightness={str(work.even).lower()}'
    description = (f'{SOURCE} {align} ! tee name=s  s. ! queue ! dffdepth name=d unit=index prefer={work.prefer}  d.src ! tee name=t '
                   f't. ! {sink("depth")}  t. ! queue ! c.depth  d.confidence ! {sink("confidence")} '
                   f's. ! queue ! c.stack  aifcompose name=c blend=sharp ! {sink("picture")}')
    with running(description, work.tell) as run:
        buffer = stack_buffer(planes, count, encoding, width, height)
        picture, depth, confidence = run.results(buffer, caps_of(encoding, width, height, count), ('picture', 'depth', 'confidence'))
        del buffer
    code = array_of(depth, '<u2', 1)[:, :, 0]
    return Solved(array_of(picture, encoding.kind, encoding.channels), planes_of_code(code, count),
                  array_of(confidence, 'u1', 1)[:, :, 0])


def planes_of_code(code, count):
    """unit=index of dffdepth to plane numbers."""
    depth = (code.astype(np.float32) - 1) * np.float32((count - 1) / 65534)
    depth[code == 0] = np.nan
    return depth


def depth_colours(code, tell):
    """Depth of 16 bits in colours for eyes: rows, columns, red, green and blue."""
    height, width = code.shape
    with running(f'{SOURCE} ! depthcolorize ! videoconvert ! video/x-raw,format=RGB ! {sink("colours")}', tell) as run:
        buffer = stack_buffer([code.astype('<u2')[:, :, None]], 1, DEPTH, width, height)
        caps = f'video/x-raw,format=GRAY16_LE,width={width},height={height},framerate=1/1'
        return array_of(run.results(buffer, caps, ('colours',))[0], 'u1', 3)


def find_warps(lumas, tell):
    """How each of at most 64 pictures of 8 bits lies against the one in the middle: dictionaries of matrix, trusted and blank."""
    height, width = lumas[0].shape
    with running(f'{SOURCE} ! focalstackalign name=align ! {sink("aligned")}', tell) as run:
        run.tell = lambda text: None  # which planes are not trusted is told by the pictures' names
        buffer = stack_buffer((plane[:, :, None] for plane in lumas), len(lumas), LUMA, width, height)
        run.results(buffer, caps_of(LUMA, width, height, len(lumas)), ('aligned',))
        stats = run.element('align').get_property('stats')
        planes = values_of(stats, 'planes')
        return [{'matrix': np.array(values_of(plane, 'matrix')).reshape(3, 3), 'trusted': plane.get_value('trusted'),
                 'blank': plane.get_value('blank')} for plane in planes]


def values_of(structure, field):
    """The values of an array in a structure."""
    found, array = structure.get_array(field)
    values = [array.get_nth(k) for k in range(array.n_values)] if found else []
    return [value.copy() if isinstance(value, Gst.Structure) else value for value in values]  # which the array would take along
