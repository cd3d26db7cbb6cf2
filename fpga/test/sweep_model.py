# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What a sweep must look like, worked out from the table alone, and how to write a table through the host's bus.

Independent of the VHDL: times are computed in whole clock cycles from the times of the table, the 29 bits of a byte
write and the handover between two writes that doc/sweep_sequencer.md states.
"""

import random
from dataclasses import dataclass, field

from words import BIT, WORD

WRITE_BITS = 29
HANDOVER_CYCLES = 2      # from the end of a write to the first bit of the next
FIRST_CYCLES = 1         # from the start of a slot to the first bit of its first write
WAIT_CYCLES = 1          # to see the end of the delay
PIN_CYCLES = 2           # from a time of the slot to the edge at the pin


@dataclass
class Plane:
    code_a: int
    delay_us: int
    code_b: int
    settle_us: int


@dataclass
class Table:
    planes: list
    period_us: int = 6400
    exposure_us: int = 6000
    flyback_us: int = 0
    trigger_width_us: int = 100
    opto_on_us: int = 0
    opto_off_us: int = 0
    triangle: bool = False
    active_low: bool = False

    @property
    def lead_us(self):
        return self.opto_off_us if self.active_low else self.opto_on_us

    @property
    def trail_us(self):
        return self.opto_on_us if self.active_low else self.opto_off_us

    def words(self):
        shape = BIT["shape.triangle"] * self.triangle + BIT["shape.trigger_active_low"] * self.active_low
        return [len(self.planes), shape, self.period_us, self.exposure_us, self.flyback_us, self.trigger_width_us,
                self.opto_on_us, self.opto_off_us]

    async def write(self, host, commit=True):
        await host.write_words(WORD["planes"], self.words())
        for number, plane in enumerate(self.planes):
            await host.write_words(WORD["plane_select"],
                                   [number, plane.code_a, plane.delay_us, plane.code_b, plane.settle_us])
        if commit:
            await host.write_word(WORD["commit"], 1)


def random_table(rng: random.Random, lens_gap_us, lens_stage_us, planes=None, triangle=None):
    """A table that can be met, its first plane with no time to spare."""
    gap = lens_gap_us + rng.randrange(2, 120)
    opto = rng.randrange(0, 8), rng.randrange(0, 8)
    exposure = lens_stage_us + rng.randrange(2, 60)
    rows = []
    for number in range(planes or rng.randrange(2, 8)):
        slack = gap - lens_gap_us
        delay = rng.randrange(0, max(1, slack - 7))
        settle = slack - delay if number == 0 else rng.randrange(0, slack - delay + 1)
        if delay + max(settle, *opto) > slack:
            delay, settle = 0, slack
        rows.append(Plane(rng.randrange(1024), delay, rng.randrange(1024), settle))
    if max(opto) > gap - lens_gap_us:
        opto = 0, 0
    return Table(rows, period_us=gap + exposure, exposure_us=exposure, flyback_us=rng.choice([0, 0, 37]),
                 trigger_width_us=rng.randrange(9, exposure), opto_on_us=opto[0], opto_off_us=opto[1],
                 triangle=rng.random() < 0.5 if triangle is None else triangle, active_low=rng.random() < 0.5)


@dataclass
class Expected:
    """Times in clock cycles from the start of the first slot."""
    trigger: list = field(default_factory=list)      # (rise, fall) of the pulse
    sync: list = field(default_factory=list)
    codes: list = field(default_factory=list)        # (end of the commit, code)
    planes: list = field(default_factory=list)


def expect(table, sweeps, tick_cycles, bit_cycles, direct=False):
    """The events of the first `sweeps` sweeps after a start. direct: the driver takes bits 9..2 of a code in one write."""
    result = Expected()
    write = WRITE_BITS * bit_cycles + HANDOVER_CYCLES
    start, downward = 0, False
    for sweep in range(sweeps):
        order = range(len(table.planes))
        for position, number in enumerate(reversed(order) if downward else order):
            plane = table.planes[number]
            length = table.period_us
            if position == 0 and (sweep == 0 or not table.triangle):
                length += table.flyback_us
            exposure = start + (length - table.exposure_us) * tick_cycles
            exposure += PIN_CYCLES
            pulse = exposure - table.lead_us * tick_cycles
            width = table.trigger_width_us + table.lead_us - table.trail_us
            result.trigger.append((pulse, pulse + width * tick_cycles))
            if position == 0:
                result.sync.append((exposure, exposure + table.trigger_width_us * tick_cycles))
            end_a = start + FIRST_CYCLES + WRITE_BITS * bit_cycles
            end_b = end_a + plane.delay_us * tick_cycles + WAIT_CYCLES + (1 if direct else 3) * write
            result.codes += [(end, code >> 2 if direct else code)
                             for end, code in ((end_a, plane.code_a), (end_b, plane.code_b))]
            result.planes.append(number)
            assert end_b + plane.settle_us * tick_cycles <= exposure, "the table cannot be met"
            start += length * tick_cycles
        downward = table.triangle and not downward
    return result
