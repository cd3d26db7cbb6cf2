# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Records signals of a simulation and draws them as a timing diagram (SVG)."""

import cocotb
from cocotb.triggers import ValueChange
from cocotb.utils import get_sim_time

LEFT, WIDTH, LANE, HIGH = 150, 850, 30, 18


class Recorder:
    """Value changes of signals, from the moment it is made."""

    def __init__(self, **signals):
        self.begin = get_sim_time("ps")
        self.lanes = {name: [(0, self._value(signal))] for name, signal in signals.items()}
        for name, signal in signals.items():
            cocotb.start_soon(self._follow(signal, self.lanes[name]))

    @staticmethod
    def _value(signal):
        return int(signal.value) if signal.value.is_resolvable else 0

    async def _follow(self, signal, lane):
        while True:
            await ValueChange(signal)
            time = get_sim_time("ps") - self.begin
            if lane[-1][0] == time:
                lane.pop()  # gone before any time had passed
            lane.append((time, self._value(signal)))

    def draw(self, title, vectors=(), notes=(), states=None):
        """The picture of what was recorded up to now. vectors: names drawn as numbers; notes: (ps, text);
        states: {name: words for its numbers}."""
        end = get_sim_time("ps") - self.begin
        states = states or {}
        height = 70 + LANE * len(self.lanes)
        out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 20}" height="{height}" '
               'font-family="sans-serif" font-size="12">',
               f'<rect width="100%" height="100%" fill="white"/><text x="8" y="18" font-weight="bold">{title}</text>']
        place = lambda time: LEFT + WIDTH * time / end
        bottom = 40 + LANE * len(self.lanes)
        step = next(step for step in (size * 10**power for power in range(3, 13) for size in (1, 2, 5))
                    if end / step <= 10)
        for tick in range(0, int(end // step) + 1):
            x = place(tick * step)
            out.append(f'<line x1="{x:.1f}" y1="34" x2="{x:.1f}" y2="{bottom}" stroke="#ddd"/>'
                       f'<text x="{x:.1f}" y="{bottom + 16}" text-anchor="middle">{tick * step / 1e6:g}</text>')
        out.append(f'<text x="{LEFT - 8}" y="{bottom + 16}" text-anchor="end">us</text>')
        for row, (name, lane) in enumerate(self.lanes.items()):
            base = 40 + LANE * row + LANE - 6
            out.append(f'<text x="{LEFT - 8}" y="{base - 3}" text-anchor="end">{name}</text>')
            boxes = name in vectors or name in states
            out += self._boxes(lane, base, end, place, states.get(name)) if boxes else [
                self._line(lane, base, end, place)]
        for time, text in notes:
            x = place(time)
            out.append(f'<line x1="{x:.1f}" y1="30" x2="{x:.1f}" y2="{bottom}" stroke="#c33" stroke-dasharray="3,3"/>'
                       f'<text x="{x + 3:.1f}" y="30" fill="#c33">{text}</text>')
        return "\n".join([*out, "</svg>", ""])

    @staticmethod
    def _line(lane, base, end, place):
        points, level = [], lane[0][1]
        points.append(f"{place(0):.1f},{base - HIGH * level}")
        for time, value in lane[1:]:
            points += [f"{place(time):.1f},{base - HIGH * level}", f"{place(time):.1f},{base - HIGH * value}"]
            level = value
        points.append(f"{place(end):.1f},{base - HIGH * level}")
        return f'<polyline points="{" ".join(points)}" fill="none" stroke="#036" stroke-width="1.3"/>'

    @staticmethod
    def _boxes(lane, base, end, place, words):
        out = []
        for (time, value), (until, _) in zip(lane, [*lane[1:], (end, None)]):
            left, right = place(time), place(until)
            if right - left < 0.2:
                continue
            text = words[value] if words else str(value)
            out.append(f'<rect x="{left:.1f}" y="{base - HIGH}" width="{right - left:.1f}" height="{HIGH}" '
                       'fill="#eef4fa" stroke="#036"/>')
            if right - left > 7 * len(text):
                out.append(f'<text x="{(left + right) / 2:.1f}" y="{base - 5}" text-anchor="middle">{text}</text>')
        return out
