# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The last frames, and what can be read off a depth frame."""
import collections
import dataclasses
import math
import threading
import time

import gi
import numpy as np

gi.require_version('GstDff', '1.0')
gi.require_version('GstVideo', '1.0')
from gi.repository import Gst, GstDff, GstVideo  # noqa: E402

UNITS = {'dioptre': 'dpt', 'index': 'plane', 'millimetre': 'mm', 'micrometre': 'µm'}
BINS = 64  # of the histogram, over the range of the stream
STEPS = 512  # of a profile, at most

TYPES = ((Gst, 'Buffer BufferFlags Caps ClockTime Event FlowReturn Format Message PadProbeInfo PadProbeReturn Promise PromiseResult '
               'Query Sample Segment Structure SystemClock'),
         (GstVideo, 'VideoFormatInfo VideoInfo VideoMeta VideoFrameFlags'), (GstDff, 'DepthMeta DepthUnit FocalStackMeta FocusInfo'))


def load_types(types=TYPES):
    """Here and now what streaming threads will need: two that load one at the same time get two."""
    for module, names in types:
        for name in names.split():
            getattr(module, name, None)


def pixels_of(buffer, caps, kind, meta_id=0):
    """Rows of the first component of a frame, without their padding. A copy."""
    info = GstVideo.VideoInfo.new_from_caps(caps)
    meta = GstVideo.buffer_get_video_meta_id(buffer, meta_id)
    offset, stride = (meta.offset[0], meta.stride[0]) if meta else (info.offset[0], info.stride[0])
    item = np.dtype(kind).itemsize
    size = stride * (info.height - 1) + info.width * item
    data = np.frombuffer(buffer.extract_dup(offset, size), np.uint8)
    if len(data) < size:
        raise ValueError(f'a frame of {len(data)} bytes is not {info.width}x{info.height}')
    padded = np.zeros(stride * info.height, np.uint8)
    padded[:size] = data
    return padded.reshape(info.height, stride)[:, :info.width * item].copy().view(kind)


@dataclasses.dataclass
class Depth:
    """A depth frame and what its pixels mean: offset + scale * pixel, 0 is not known."""
    sample: Gst.Sample
    unit: str
    scale: float
    offset: float
    near: float
    far: float
    intrinsics: tuple
    sequence: int

    @classmethod
    def of(cls, sample):
        buffer, caps = sample.get_buffer(), sample.get_caps()
        info = GstDff.buffer_get_depth_meta(buffer)
        if info is None:
            return cls(sample, *from_fields(caps.get_structure(0)), (), 0)
        intrinsics = (info.fx, info.fy, info.cx, info.cy) if info.has_intrinsics else ()
        return cls(sample, info.unit.value_nick, info.scale, info.offset, info.near, info.far, intrinsics, info.sequence)

    def pixels(self):
        return pixels_of(self.sample.get_buffer(), self.sample.get_caps(), '<u2')

    def values(self, pixels):
        """In the unit; NaN where not known."""
        return np.where(pixels == 0, np.nan, self.offset + self.scale * pixels.astype(float))

    def metres(self, values):
        """Of a value or an array of them, in the unit; inf is as far as can be, NaN not known."""
        if self.unit == 'dioptre':
            with np.errstate(divide='ignore'):
                return 1 / np.maximum(values, 0.0)
        return values * {'millimetre': 1e-3, 'micrometre': 1e-6}.get(self.unit, math.nan)

    def facts(self):
        width, height = size_of(self.sample)
        facts = {'width': width, 'height': height, 'unit': self.unit, 'symbol': UNITS.get(self.unit, ''), 'scale': self.scale,
                 'offset': self.offset, 'near': self.near, 'far': self.far, 'sequence': self.sequence}
        if self.intrinsics:
            facts['intrinsics'] = dict(zip(('fx', 'fy', 'cx', 'cy'), self.intrinsics))
        return without_nan(facts)


def from_fields(structure):
    """Unit, scale, offset, near and far, of depth without a meta: what its caps say."""
    near, far = (structure.get_value(name) if structure.has_field(name) else math.nan for name in ('depth-near', 'depth-far'))
    unit = structure.get_string('depth-unit') or ''
    if unit == 'dioptre' and math.isfinite(near - far):
        scale = (far - near) / 65534
        return unit, scale, near - scale, near, far
    return ('millimetre', 1.0, 0.0, near, far) if unit == 'millimetre' else ('', 1.0, 0.0, near, far)


def without_nan(value):
    """JSON has no numbers that are none."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def size_of(sample):
    structure = sample.get_caps().get_structure(0)
    return structure.get_value('width'), structure.get_value('height')


def rate_of(arrivals, now):
    """A second, with none but the last three seconds or frames; less when the next one is overdue."""
    recent = [arrival for arrival in arrivals if now - arrival < 3]
    recent = list(arrivals)[-3:] if len(recent) < 3 else recent
    if len(recent) < 2 or recent[-1] == recent[0]:
        return 0.0
    overdue = max(0.0, now - recent[-1] - (recent[-1] - recent[-2]))
    return (len(recent) - 1) / (recent[-1] + overdue - recent[0])


class Frames:
    """The last frame of each output. Filled by streaming threads, read by any."""

    def __init__(self):
        self.lock = threading.Lock()
        self.last = {}
        self.depths = collections.deque(maxlen=6)  # since a picture comes later than its depth
        self.arrivals = collections.deque(maxlen=64)  # of depth, or of pictures where there is none
        self.age = self.latest = None

    def put(self, output, sample, age):
        with self.lock:
            self.last[output] = sample
            self.latest = time.monotonic()
            if output == 'depth':
                self.depths.append(sample)
            if output == 'depth' or (output == 'aif' and 'depth' not in self.last):
                self.arrivals.append(time.monotonic())
                self.age = age

    def get(self, output):
        with self.lock:
            return self.last.get(output)

    def depth(self):
        sample = self.get('depth')
        return Depth.of(sample) if sample else None

    def pair(self):
        """The last picture and the depth it was made with; None for what there is not."""
        with self.lock:
            picture = self.last.get('aif')
            depth = self.last.get('depth')
            for sample in self.depths:
                if picture and sample.get_buffer().pts == picture.get_buffer().pts:
                    depth = sample
        return picture, Depth.of(depth) if depth else None

    def pace(self):
        """Frames a second over the last three, or over the last three frames where they take longer; and seconds from the first
        exposure of the last until it was there."""
        with self.lock:
            return rate_of(self.arrivals, time.monotonic()), self.age if self.arrivals else None

    def silence(self):
        """Seconds since the last frame of any output; none where there was none."""
        with self.lock:
            return time.monotonic() - self.latest if self.latest else 0.0

    def forget(self):
        with self.lock:
            self.last.clear()
            self.depths.clear()
            self.arrivals.clear()
            self.latest = None


def place(shape, x, y):
    """The pixel at a place given in parts of width and height."""
    height, width = shape
    return min(max(int(x * width), 0), width - 1), min(max(int(y * height), 0), height - 1)


def deviation_at(uncertainty, column, row):
    """One standard deviation of a pixel in the unit of its depth; NaN where not known. `uncertainty`: its sample."""
    info = GstDff.buffer_get_depth_meta(uncertainty.get_buffer())
    pixel = pixels_of(uncertainty.get_buffer(), uncertainty.get_caps(), '<u2')[row, column]
    return info.scale * float(pixel) if info and pixel else math.nan


def value_at(depth, x, y, overlays, uncertainty=None):
    """What is known of a place: x, y in parts of width and height; `overlays`: samples by name."""
    pixels = depth.pixels()
    column, row = place(pixels.shape, x, y)
    value = float(depth.values(pixels[row, column]))
    found = {'x': column, 'y': row, 'pixel': int(pixels[row, column]), 'value': value, 'unit': depth.unit,
             'symbol': UNITS.get(depth.unit, ''), 'metres': float(depth.metres(value))}
    for name, sample in overlays.items():
        overlay = pixels_of(sample.get_buffer(), sample.get_caps(), 'u1')
        at_x, at_y = place(overlay.shape, x, y)
        found[name] = int(overlay[at_y, at_x]) / 255
    if uncertainty and size_of(uncertainty) == size_of(depth.sample):
        found['deviation'] = deviation_at(uncertainty, column, row)
    return without_nan(found)


def profile(depth, x0, y0, x1, y1):
    """Values along a line, and its length in pixels of the depth frame."""
    pixels = depth.pixels()
    (left, top), (right, bottom) = place(pixels.shape, x0, y0), place(pixels.shape, x1, y1)
    length = math.hypot(right - left, bottom - top)
    count = max(2, min(STEPS, int(length) + 1))
    columns = np.round(np.linspace(left, right, count)).astype(int)
    rows = np.round(np.linspace(top, bottom, count)).astype(int)
    return {'length': length, 'unit': depth.unit, 'symbol': UNITS.get(depth.unit, ''),
            'values': without_nan(depth.values(pixels[rows, columns]).tolist())}


def histogram(depth):
    """Of every second pixel each way, nearest first, and the values at both ends."""
    pixels = depth.pixels()[::2, ::2]
    known = pixels[pixels > 0]
    counts = np.bincount((known.astype(np.uint32) - 1) * BINS // 65535, minlength=BINS)
    return without_nan({'counts': counts.tolist(), 'known': known.size / max(1, pixels.size), 'first': depth.offset + depth.scale,
                        'last': depth.offset + depth.scale * 65535, 'unit': depth.unit, 'symbol': UNITS.get(depth.unit, '')})
