# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""i2c_master against the model of the lens driver: transfers, timing, every fault."""

import random

import cocotb
from cocotb.triggers import FallingEdge, ValueChange
from cocotb.utils import get_sim_time

import coverage
from entity import CLOCK_HZ, CLOCK_PS, OpenDrain, begin, cycles, cycles_until, pulse
from max14574 import ADDRESS, Max14574

BIT = CLOCK_HZ // 400_000
WRITE = 29 * BIT
LIMIT = CLOCK_HZ // 10_000          # 100 us
FAULTS = ("nack", "stretched", "stuck", "arbitration_lost")


class Rig:
    def __init__(self, dut):
        self.dut = dut
        self.scl = OpenDrain(dut.scl_in, dut.scl_low, 2 * CLOCK_PS)
        self.sda = OpenDrain(dut.sda_in, dut.sda_low, 2 * CLOCK_PS)
        self.foreign_scl, self.foreign_sda = self.scl.pull(), self.sda.pull()
        self.lens = Max14574(dut.scl_in, dut.sda_in, self.scl.pull(), self.sda.pull())
        coverage.watch("i2c_master", dut.state)

    async def begin(self):
        await begin(self.dut, start=0, address=ADDRESS, register_number=0, value=0)
        await cycles(self.dut, 20)

    async def write(self, register, value, limit=4 * WRITE):
        """Gives (cycles from start to done, names of the faults)."""
        self.dut.register_number.value = register
        self.dut.value.value = value
        await pulse(self.dut, self.dut.start)
        assert int(self.dut.busy.value) == 1
        taken = 1 + await cycles_until(self.dut, self.dut.done, 1, limit)
        found = {name for name in FAULTS if int(getattr(self.dut, name).value)}
        await cycles(self.dut, 1)
        assert int(self.dut.done.value) == 0 and int(self.dut.busy.value) == 0
        return taken, found

    def bus_is_free(self):
        return int(self.dut.scl_low.value) == 0 and int(self.dut.sda_low.value) == 0


@cocotb.test()
async def writes_arrive_and_take_29_bits(dut):
    rig = Rig(dut)
    await rig.begin()
    rng = random.Random(2)
    sent = [(rng.randrange(256), rng.randrange(256)) for _ in range(12)] + [(0, 0), (255, 255)]
    for register, value in sent:
        assert await rig.write(register, value) == (WRITE + 1, set())
    await cycles(dut, 5)
    assert [write[1:] for write in rig.lens.writes] == sent
    assert rig.bus_is_free()


@cocotb.test()
async def writes_may_follow_each_other_at_once(dut):
    rig = Rig(dut)
    await rig.begin()
    for number in range(3):
        dut.register_number.value = number
        await pulse(dut, dut.start)
        await cycles_until(dut, dut.done, 1, 2 * WRITE)
        assert not any(int(getattr(dut, name).value) for name in FAULTS)
    await cycles(dut, 5)
    assert [write[1] for write in rig.lens.writes] == [0, 1, 2]


@cocotb.test()
async def clock_keeps_the_times_of_a_fast_mode_bus(dut):
    rig = Rig(dut)
    await rig.begin()
    edges = []

    async def follow():
        while True:
            await ValueChange(dut.scl_low)
            edges.append((get_sim_time("ps"), int(dut.scl_low.value)))

    cocotb.start_soon(follow())
    await rig.write(0x55, 0xA5)
    falls = [time for time, low in edges if low]
    rises = [time for time, low in edges if not low]
    assert len(falls) == len(rises) == 28
    assert all(rise - fall >= 1_300_000 for fall, rise in zip(falls, rises)), "SCL low for less than 1.3 us"
    assert all(fall - rise >= 600_000 for rise, fall in zip(rises, falls[1:])), "SCL high for less than 0.6 us"
    assert all(after - before >= 2_500_000 for before, after in zip(falls, falls[1:])), "faster than 400 kHz"


@cocotb.test()
async def missing_acknowledge_ends_in_a_stop(dut):
    rig = Rig(dut)
    await rig.begin()
    for byte in range(3):
        rig.lens.nack_at = {len(rig.lens.starts): byte}
        taken, faults = await rig.write(8, 1)
        assert faults == {"nack"} and taken == (2 + 9 * (byte + 1)) * BIT + 1
        await cycles(dut, 5)
        assert rig.bus_is_free() and rig.lens.payload is None
    rig.lens.nack_at = {}
    dut.address.value = 0x10
    assert (await rig.write(8, 1))[1] == {"nack"}
    dut.address.value = ADDRESS
    assert (await rig.write(8, 1))[1] == set()
    await cycles(dut, 5)
    assert len(rig.lens.writes) == 1


@cocotb.test()
async def stretched_clock_is_waited_for(dut):
    rig = Rig(dut)
    await rig.begin()
    rig.lens.stretch_at = {0: (LIMIT - 40) * CLOCK_PS}
    taken, faults = await rig.write(8, 0x5A)
    assert faults == set() and taken > WRITE + LIMIT - 80
    await cycles(dut, 5)
    assert rig.lens.writes[0][1:] == (8, 0x5A)


@cocotb.test()
async def clock_stretched_for_too_long_is_given_up(dut):
    rig = Rig(dut)
    await rig.begin()
    rig.lens.stretch_at = {0: 3 * LIMIT * CLOCK_PS}
    taken, faults = await rig.write(8, 0x5A)
    assert faults == {"stretched"} and LIMIT < taken < LIMIT + 12 * BIT
    assert rig.bus_is_free()
    await cycles(dut, 3 * LIMIT)
    assert (await rig.write(8, 0x11))[1] == set()


@cocotb.test()
async def clock_held_before_the_start(dut):
    rig = Rig(dut)
    await rig.begin()
    rig.foreign_scl.value = 1
    taken, faults = await rig.write(8, 1)
    assert faults == {"stretched"} and LIMIT < taken < LIMIT + 2 * BIT
    rig.foreign_scl.value = 0
    await cycles(dut, 10)
    assert (await rig.write(8, 1))[1] == set()


@cocotb.test()
async def held_data_line_is_freed_by_up_to_nine_clocks(dut):
    rig = Rig(dut)
    await rig.begin()
    for clocks in range(1, 10):
        rig.lens.hold(clocks)
        await cycles(dut, 10)
        taken, faults = await rig.write(8, clocks)
        assert faults == set(), f"{faults} after {clocks} clocks"
        assert taken > WRITE + clocks * BIT
        await cycles(dut, 5)
        assert rig.lens.writes[-1][1:] == (8, clocks)


@cocotb.test()
async def data_line_that_stays_low_is_stuck(dut):
    rig = Rig(dut)
    await rig.begin()
    falls = 0

    async def count():
        nonlocal falls
        while True:
            await FallingEdge(dut.scl_in)
            falls += 1

    cocotb.start_soon(count())
    rig.lens.hold(None)
    await cycles(dut, 10)
    _, faults = await rig.write(8, 1)
    assert faults == {"stuck"}
    assert falls == 9
    assert rig.bus_is_free()
    rig.lens.release()
    await cycles(dut, 10)
    assert (await rig.write(8, 1))[1] == set()


@cocotb.test()
async def foreign_low_bit_loses_the_arbitration(dut):
    rig = Rig(dut)
    await rig.begin()
    dut.register_number.value = 0xFF
    await pulse(dut, dut.start)
    for _ in range(12):
        await FallingEdge(dut.scl_in)
    rig.foreign_sda.value = 1
    await cycles_until(dut, dut.done, 1, 3 * BIT)
    assert int(dut.arbitration_lost.value) == 1 and int(dut.nack.value) == 0
    assert rig.bus_is_free()
    rig.foreign_sda.value = 0
    await cycles(dut, 20)
    assert (await rig.write(8, 1))[1] == set()


@cocotb.test()
async def reset_releases_the_bus(dut):
    rig = Rig(dut)
    await rig.begin()
    await pulse(dut, dut.start)
    await cycles(dut, 5 * BIT)
    dut.reset.value = 1
    await cycles(dut, 1)
    assert rig.bus_is_free() and int(dut.busy.value) == 0
    dut.reset.value = 0
    await cycles(dut, 20)
    assert (await rig.write(8, 1))[1] == set()
