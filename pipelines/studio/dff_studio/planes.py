# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The planes of a stack, one by one, and how sharp each is at a place."""
import math
import threading

import numpy as np
from gi.repository import Gst, GstDff, GstVideo

from dff_studio.frames import place, without_nan

WINDOW = 8  # pixels on each side of the place over which sharpness is summed
PLATEAU = 0.98  # of the greatest sharpness, above which planes are taken for equally sharp
LUMA = np.array([0.299, 0.587, 0.114])  # of red, green, blue: BT.601
# Places of red, green and blue among the samples of a pixel; where there is one, it is luma.
SAMPLES = {'GRAY8': ('u1', 1, (0,)), 'GRAY16_LE': ('<u2', 1, (0,)), 'I420': ('u1', 1, (0,)), 'NV12': ('u1', 1, (0,)),
           'RGB': ('u1', 3, (0, 1, 2)), 'BGR': ('u1', 3, (2, 1, 0)), 'RGBx': ('u1', 4, (0, 1, 2)), 'BGRx': ('u1', 4, (2, 1, 0)),
           'RGBA64_LE': ('<u2', 4, (0, 1, 2))}


class Stack:
    """A stack of its own memory: buffer and caps as dffdepth gets them."""

    def __init__(self, buffer, caps):
        self.buffer = buffer
        structure = caps.get_structure(0)
        self.format = structure.get_string('format')
        self.width, self.height, self.planes = (structure.get_value(name) for name in ('width', 'height', 'planes'))
        self.caps = Gst.Caps.from_string(f'video/x-raw,format={self.format},width={self.width},height={self.height},framerate=0/1')
        if colorimetry := structure.get_string('colorimetry'):
            self.caps.set_value('colorimetry', colorimetry)
        self.info = GstVideo.VideoInfo.new_from_caps(self.caps)

    def layout(self, plane):
        """Offsets and strides of a plane in the buffer."""
        if meta := GstVideo.buffer_get_video_meta_id(self.buffer, plane):
            return list(meta.offset), list(meta.stride)
        start = plane * self.info.size
        return [start + offset for offset in self.info.offset], list(self.info.stride)

    def luma(self, plane, left, top, right, bottom):
        """A part of a plane as brightness."""
        kind, channels, places = SAMPLES[self.format]
        offsets, strides = self.layout(plane)
        item = np.dtype(kind).itemsize * channels
        rows = []
        for row in range(top, bottom):
            data = self.buffer.extract_dup(offsets[0] + row * strides[0] + left * item, (right - left) * item)
            rows.append(np.frombuffer(data, kind).reshape(-1, channels))
        picked = np.stack(rows)[:, :, list(places)].astype(float)
        return picked[:, :, 0] if len(places) == 1 else picked @ LUMA

    def sample(self, plane):
        """A plane as a frame of its own."""
        offsets, strides = self.layout(plane)
        parts = self.info.finfo.n_planes
        size = self.info.size if parts == 1 else offsets[parts - 1] - offsets[0] + self.info.size - self.info.offset[parts - 1]
        size = max(size, strides[0] * self.height) if parts == 1 else size
        frame = Gst.Buffer.new_wrapped(self.buffer.extract_dup(offsets[0], size))
        GstVideo.buffer_add_video_meta_full(frame, GstVideo.VideoFrameFlags.NONE, self.info.finfo.format, self.width, self.height,
                                            parts, [offset - offsets[0] for offset in offsets[:parts]] + [0] * (4 - parts),
                                            list(strides[:parts]) + [0] * (4 - parts))
        frame.pts = 0
        return Gst.Sample.new(frame, self.caps, None, None)

    def powers(self):
        """Object vergences of the planes in dioptres, or stage positions in micrometres, and which of both; else numbers."""
        meta = GstDff.buffer_get_focal_stack_meta(self.buffer)
        facts = []
        for plane in range(self.planes):
            known, found = meta.get_focus(plane) if meta else (False, None)
            if known:
                facts.append(found)
        for name, unit in (('power', 'dpt'), ('position_um', 'µm')):
            values = [getattr(found, name) for found in facts]
            if len(values) == self.planes and all(math.isfinite(value) for value in values):
                return values, unit
        return list(range(self.planes)), 'plane'

    def sharpness(self, x, y):
        """At a place in parts of width and height: the mean square of second differences over a window, for each plane, the
        largest being 1; and where a parabola through the logarithms of the largest and its neighbours peaks, in planes, or the
        middle of a plateau."""
        column, row = place((self.height, self.width), x, y)
        left, right = max(0, column - WINDOW - 1), min(self.width, column + WINDOW + 2)
        top, bottom = max(0, row - WINDOW - 1), min(self.height, row + WINDOW + 2)
        measured = np.array([curvature(self.luma(plane, left, top, right, bottom)) for plane in range(self.planes)])
        positions, unit = self.powers()
        peak = peak_of(measured)
        return without_nan({'x': column, 'y': row, 'curve': (measured / max(measured.max(), 1e-9)).tolist(), 'peak': peak,
                            'at': float(np.interp(peak, range(self.planes), positions)), 'positions': positions, 'unit': unit})


def curvature(luma):
    """Mean square of the second differences along rows and columns."""
    inner = 2 * luma[1:-1, 1:-1]
    across = inner - luma[1:-1, :-2] - luma[1:-1, 2:]
    down = inner - luma[:-2, 1:-1] - luma[2:, 1:-1]
    return float(np.mean(across ** 2 + down ** 2)) if inner.size else 0.0


def peak_of(measured):
    best = int(np.argmax(measured))
    first = last = best
    while first > 0 and measured[first - 1] > PLATEAU * measured[best]:
        first -= 1
    while last < len(measured) - 1 and measured[last + 1] > PLATEAU * measured[best]:
        last += 1
    if last - first > 1:  # a fine sweep, of which several planes are as sharp as can be
        return (first + last) / 2
    if best in (0, len(measured) - 1) or measured.min() <= 0:
        return float(best)
    before, here, after = np.log(measured[best - 1:best + 2])
    bend = before - 2 * here + after
    return best + float((before - after) / (2 * bend)) if bend < 0 else float(best)


class StackTap:
    """Copies the next stack on its way into dffdepth, when somebody asks; costs nothing otherwise."""

    def __init__(self, depth_element):
        self.pad = depth_element.get_static_pad('sink') if depth_element else None
        self.waiting, self.lock, self.probe = [], threading.Lock(), None

    def ask(self, function):
        """`function(stack)` is called once by the streaming thread. Returns whether there are stacks at all."""
        if not self.pad:
            return False
        with self.lock:
            self.waiting.append(function)
            if not self.probe:
                self.probe = self.pad.add_probe(Gst.PadProbeType.BUFFER, self.take)
        return True

    def take(self, pad, info):
        with self.lock:
            functions, self.waiting, self.probe = self.waiting, [], None
        caps = pad.get_current_caps()
        if caps and caps.get_structure(0).get_name() == 'video/x-focal-stack':
            stack = Stack(info.get_buffer().copy_deep(), caps)
            for function in functions:
                function(stack)
        return Gst.PadProbeReturn.REMOVE
