# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What the benches of single entities share: clock and reset, bounded waits, open-drain lines."""

import os

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, RisingEdge, Timer, ValueChange

CLOCK_HZ = int(os.environ.get("BENCH_CLOCK_HZ", 8_000_000))
CLOCK_PS = 10**12 // CLOCK_HZ

_clock = []


def drive(dut, **inputs):
    """Starts the clock if this is the first time in a test, sets inputs."""
    if not _clock or _clock[0].done():
        _clock[:] = [cocotb.start_soon(Clock(dut.clk, CLOCK_PS, unit="ps").start())]
    for name, value in inputs.items():
        getattr(dut, name).value = value


async def begin(dut, **inputs):
    """The same, and a reset."""
    drive(dut, reset=1, **inputs)
    await cycles(dut, 4)
    dut.reset.value = 0
    await cycles(dut, 2)


async def cycles(dut, count):
    """Ends at a falling edge, so that inputs change away from the rising one."""
    for _ in range(count):
        await FallingEdge(dut.clk)


async def cycles_until(dut, signal, level, limit):
    """Clock cycles until the signal has the level; fails after `limit`."""
    for count in range(limit + 1):
        if int(signal.value) == level:
            return count
        await FallingEdge(dut.clk)
    raise AssertionError(f"{signal._name} did not become {level} in {limit} cycles")


async def pulse(dut, signal):
    """One clock cycle high."""
    signal.value = 1
    await cycles(dut, 1)
    signal.value = 0


def collect(dut, signal, *values):
    """The list of (cycle-exact ps, values) of every cycle in which the signal is high."""
    from cocotb.utils import get_sim_time
    found = []

    async def follow():
        while True:
            await RisingEdge(signal)
            found.append((get_sim_time("ps"), *(int(value.value) for value in values)))

    cocotb.start_soon(follow())
    return found


class Pull:
    """One driver of an open-drain line; value 1 pulls it low."""

    def __init__(self, line):
        self.line, self.level = line, 0

    @property
    def value(self):
        return self.level

    @value.setter
    def value(self, level):
        self.level = level
        self.line.update()


class OpenDrain:
    """A line with a pull-up that the entity sees on its input `seen`, delayed as by a synchroniser."""

    def __init__(self, seen, entity_low=None, delay_ps=0):
        self.seen, self.entity_low, self.delay_ps = seen, entity_low, delay_ps
        self.pulls = []
        seen.value = 1
        if entity_low is not None:
            cocotb.start_soon(self._follow())

    def pull(self):
        self.pulls.append(Pull(self))
        return self.pulls[-1]

    @property
    def value(self):
        entity = self.entity_low is not None and self.entity_low.value == 1
        return 0 if entity or any(pull.level for pull in self.pulls) else 1

    def update(self):
        cocotb.start_soon(self._later(self.value))

    async def _later(self, level):
        if self.delay_ps:
            await Timer(self.delay_ps, unit="ps")
        self.seen.value = level

    async def _follow(self):
        while True:
            await ValueChange(self.entity_low)
            self.update()
