# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""plane_order: which plane comes next, and its row."""

import random

import cocotb
from cocotb.triggers import RisingEdge

from entity import begin, cycles, cycles_until, pulse

FETCH_CYCLES = 13
# A table that is exchanged with a new sweep is there this long after the fetch has begun
EXCHANGE_CYCLES = 3
INPUTS = dict(at_rest=1, fetch=0, advance=0, planes=3, triangle=0, flyback=0, table_data=0)


class Rig:
    """A table that answers a cycle after a read, and the slots that follow from it."""

    def __init__(self, dut):
        self.dut, self.rows = dut, []
        cocotb.start_soon(self._answer())

    async def begin(self, planes, **changes):
        await begin(self.dut, **(INPUTS | dict(planes=planes) | changes))
        self.exchange(planes)
        self.dut.at_rest.value = 0

    def exchange(self, planes):
        rng = random.Random(planes)
        self.rows = [[rng.randrange(1024), rng.randrange(0x10000), rng.randrange(1024), rng.randrange(0x10000)]
                     for _ in range(planes)]
        self.dut.planes.value = planes

    async def _answer(self):
        dut = self.dut
        while True:
            await RisingEdge(dut.table_read)
            while int(dut.table_read.value):
                plane, column = int(dut.table_plane.value), int(dut.table_column.value)
                await RisingEdge(dut.clk)
                dut.table_data.value = self.rows[plane][column]
                await cycles(dut, 1)

    async def fetch(self, exchange=None):
        """Reads the row of the next slot; gives (flyback, row). exchange: planes of a table that comes meanwhile."""
        dut = self.dut
        dut.fetch.value = 1
        if exchange:
            await cycles(dut, EXCHANGE_CYCLES)
            self.exchange(exchange)
        last = await cycles_until(dut, dut.fetched, 1, FETCH_CYCLES)
        assert last + (EXCHANGE_CYCLES if exchange else 0) == FETCH_CYCLES - 1
        await cycles(dut, 1)
        dut.fetch.value = 0
        await cycles(dut, 2)
        return int(dut.next_flyback.value), [int(word.value) for word in (dut.code_a, dut.delay, dut.code_b, dut.settle)]

    async def slot(self, exchange=None):
        """Fetches, goes there; gives (plane, downward, first, last, flyback)."""
        flyback, row = await self.fetch(exchange)
        await pulse(self.dut, self.dut.advance)
        dut = self.dut
        plane, *others = (int(signal.value) for signal in (dut.plane, dut.downward, dut.first, dut.last))
        assert row == self.rows[plane]
        return plane, *others, flyback


@cocotb.test()
async def sawtooth_begins_each_sweep_with_plane_0(dut):
    rig = Rig(dut)
    for planes in (2, 5, 64):
        await rig.begin(planes, flyback=70)
        for position in [*range(planes)] * 2 + [0]:
            first, last = position == 0, position == planes - 1
            assert await rig.slot() == (position, 0, first, last, 70 * first)


@cocotb.test()
async def triangle_turns_at_both_ends_and_flies_back_once(dut):
    rig = Rig(dut)
    for planes in (2, 5, 64):
        await rig.begin(planes, triangle=1, flyback=70)
        for sweep in range(3):
            for position in range(planes):
                first, last, downward = position == 0, position == planes - 1, sweep % 2
                plane = planes - 1 - position if downward else position
                assert await rig.slot() == (plane, downward, first, last, 70 * (first and sweep == 0))


@cocotb.test()
async def table_exchanged_with_a_new_sweep_counts_for_it(dut):
    rig = Rig(dut)
    await rig.begin(3)
    assert [(await rig.slot())[0] for _ in range(3)] == [0, 1, 2]
    dut.triangle.value = 1
    assert await rig.slot(exchange=5) == (4, 1, 1, 0, 0)
    assert [(await rig.slot())[0] for _ in range(4)] == [3, 2, 1, 0]
    assert await rig.slot(exchange=2) == (0, 0, 1, 0, 0)
    assert await rig.slot() == (1, 0, 0, 1, 0)


@cocotb.test()
async def rest_begins_anew_from_anywhere(dut):
    rig = Rig(dut)
    for triangle in (0, 1):
        for slots in range(1, 9):
            await rig.begin(3, triangle=triangle, flyback=70)
            for _ in range(slots):
                await rig.slot()
            dut.at_rest.value = 1
            await cycles(dut, 1)
            assert int(dut.downward.value) == 0
            dut.at_rest.value = 0
            assert await rig.slot() == (0, 0, 1, 0, 70), f"after {slots} slots"


@cocotb.test()
async def fetch_given_up_reads_no_further(dut):
    rig = Rig(dut)
    for moment in range(1, FETCH_CYCLES):
        await rig.begin(3)
        await rig.slot()
        dut.fetch.value = 1
        await cycles(dut, moment)
        dut.fetch.value = 0
        await cycles(dut, 1)
        for _ in range(FETCH_CYCLES):
            assert not int(dut.table_read.value) and not int(dut.fetched.value)
            await cycles(dut, 1)
        assert int(dut.plane.value) == 0
        assert (await rig.slot())[0] == 1, f"given up after {moment} cycles"


@cocotb.test()
async def reset_ends_a_fetch(dut):
    rig = Rig(dut)
    await rig.begin(3)
    await rig.slot()
    await rig.slot()
    dut.fetch.value = 1
    await cycles(dut, 8)
    dut.reset.value = 1
    await cycles(dut, 1)
    assert [int(signal.value) for signal in (dut.table_read, dut.plane, dut.table_plane, dut.downward)] == [0] * 4
    dut.fetch.value = 0
    dut.reset.value = 0
    assert (await rig.slot())[0] == 0
