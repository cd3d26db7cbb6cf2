# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The top on its bench: the models connected, pulses recorded, waits bounded."""

import os

import cocotb
from cocotb.triggers import SimTimeoutError, Timer, ValueChange, with_timeout
from cocotb.utils import get_sim_time

import coverage
from i2c_host import I2cHost
from max14574 import Max14574
from words import BIT, WORD, errors_of

CLOCK_HZ = int(os.environ.get("BENCH_CLOCK_HZ", 8_000_000))
SCALE = int(os.environ.get("BENCH_SCALE", 1))
CLOCK_PS = 10**12 // CLOCK_HZ // 2 * 2
TICK_CYCLES = CLOCK_HZ // (1_000_000 * SCALE)
BIT_CYCLES = -(-CLOCK_HZ // (400_000 * SCALE))


class Bench:
    def __init__(self, dut, driver=Max14574):
        self.dut = dut
        dut.reset_button.value = 0
        dut.run.value = 0
        self.lens = driver(dut.lens_scl, dut.lens_sda, dut.lens_scl_low, dut.lens_sda_low)
        self.host = I2cHost(dut.host_scl_low, dut.host_sda_low, dut.host_sda, bit_ps=max(24, BIT_CYCLES) * CLOCK_PS)
        self.triggers, self.syncs = [], []
        cocotb.start_soon(self._record(dut.trigger, self.triggers))
        cocotb.start_soon(self._record(dut.sync, self.syncs))
        for entity, path in (("sweep_sequencer", dut.dut.sequencer), ("i2c_master", dut.dut.lens),
                             ("i2c_slave", dut.dut.host.slave), ("plane_table", dut.dut.host.planes_table)):
            coverage.watch(entity, path.state)

    @staticmethod
    async def _record(signal, edges):
        """Edges as (ps, level)."""
        while True:
            await ValueChange(signal)
            edges.append((get_sim_time("ps"), int(signal.value)))

    async def reset(self):
        """A press of the button; every test begins with it, the simulation goes on from the test before."""
        self.dut.reset_button.value = 1
        await Timer(40 * CLOCK_PS, unit="ps")
        self.dut.reset_button.value = 0
        await Timer(40 * CLOCK_PS, unit="ps")
        self.lens.release()
        for record in (self.triggers, self.syncs, self.lens.writes, self.lens.codes, self.lens.starts,
                       self.lens.nack_at, self.lens.stretch_at):
            record.clear()

    async def wait_us(self, time_us):
        """Microseconds of the sequencer, which run SCALE times faster."""
        await Timer(time_us * TICK_CYCLES * CLOCK_PS, unit="ps")

    async def until(self, signal, level, limit_us):
        """Waits for a level, and fails if it does not come."""
        async def wait():
            while int(signal.value) != level:
                await ValueChange(signal)
        try:
            await with_timeout(wait(), limit_us * TICK_CYCLES * CLOCK_PS, "ps")
        except SimTimeoutError:
            raise AssertionError(f"{signal._path} did not become {level} in {limit_us} us") from None

    async def until_triggers(self, count, limit_us, active=1):
        """Waits until `count` trigger pulses have begun."""
        async def wait():
            while len(self.trigger_starts(active)) < count:
                await ValueChange(self.dut.trigger)
                await Timer(1, unit="ps")
        try:
            await with_timeout(wait(), limit_us * TICK_CYCLES * CLOCK_PS, "ps")
        except SimTimeoutError:
            raise AssertionError(f"{len(self.trigger_starts())} triggers in {limit_us} us, not {count}") from None

    def trigger_starts(self, active=1):
        return [time for time, level in self.triggers if level == active]

    async def control(self, *names):
        await self.host.write_word(WORD["control"], sum(BIT[f"control.{name}"] for name in names))

    async def status(self, name):
        return bool(await self.host.read_word(WORD["status"]) & BIT[f"status.{name}"])

    async def errors(self):
        found = errors_of(await self.host.read_word(WORD["error"]))
        coverage.seen("error bit", *found)
        return found

    async def clear_errors(self):
        await self.host.write_word(WORD["error"], 0xFFFF)

    async def count(self, name):
        low = await self.host.read_word(WORD[f"{name}_count_low"])
        return await self.host.read_word(WORD[f"{name}_count_high"]) << 16 | low

    def check(self, table, expected):
        """Compares every recorded edge and code with the model, to the clock."""
        active = 0 if table.active_low else 1
        triggers = pulses(self.triggers, active)
        syncs = pulses(self.syncs, 1)
        origin = triggers[0][0] - expected.trigger[0][0] * CLOCK_PS
        in_cycles = lambda edges: [tuple((time - origin) / CLOCK_PS for time in pulse) for pulse in edges]
        assert len(triggers) >= len(expected.trigger), f"{len(triggers)} triggers, not {len(expected.trigger)}"
        compare("trigger", in_cycles(triggers), expected.trigger)
        compare("sync", in_cycles(syncs), expected.sync)
        codes = [((time - origin) / CLOCK_PS, code) for time, code in self.lens.codes]
        compare("code", codes, expected.codes)


def pulses(edges, active):
    """(start, end) of each whole pulse."""
    starts = [time for time, level in edges if level == active]
    ends = [time for time, level in edges if level != active]
    if ends and starts and ends[0] < starts[0]:
        ends = ends[1:]
    return list(zip(starts, ends))


def compare(what, measured, expected):
    for number, (is_, should) in enumerate(zip(measured, expected)):
        assert tuple(is_) == tuple(should), f"{what} {number}: {is_} cycles, should be {should}"
    assert len(measured) >= len(expected), f"{what}: {len(measured)} seen, not {len(expected)}"
