# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""host_interface: from the host's bus to the sweep in use, and back."""

import random

import cocotb

import coverage
from entity import OpenDrain, begin, cycles, pulse
from i2c_host import I2cHost
from sweep_model import Plane, Table
from words import BIT, DEFAULT, WORD, errors_of

BIT_PS = 2_500_000
INPUTS = dict(table_plane=0, table_column=0, table_read=0, run=0, idle=1, progress_busy=0, progress_plane=0,
              progress_downward=0, progress_fire=0, progress_fire_sync=0, progress_boundary=0, sweep_faults=0)
OUTPUTS = {"planes": "sweep_planes", "period_us": "sweep_period", "exposure_us": "sweep_exposure",
           "flyback_us": "sweep_flyback", "trigger_width_us": "pulse_width", "opto_on_us": "pulse_opto_on",
           "opto_off_us": "pulse_opto_off", "lens_address": "driver_address", "lens_start": "driver_start",
           "lens_stage": "driver_stage", "lens_commit": "driver_commit"}


def table_of(seed, planes, **changes):
    """A table that can be met, with other rows for another seed."""
    rng = random.Random(seed)
    rows = [Plane(rng.randrange(1024), rng.randrange(50), rng.randrange(1024), rng.randrange(50))
            for _ in range(planes)]
    return Table(rows, **(dict(period_us=900 + seed, exposure_us=500, trigger_width_us=100 + seed) | changes))


class Rig:
    def __init__(self, dut):
        self.dut = dut
        scl, sda = OpenDrain(dut.scl_in), OpenDrain(dut.sda_in, dut.sda_low)
        self.host = I2cHost(scl.pull(), sda.pull(), sda, BIT_PS)
        coverage.watch("i2c_slave", dut.dut.slave.state)
        coverage.watch("plane_table", dut.dut.planes_table.state)

    async def begin(self, **changes):
        await begin(self.dut, **(INPUTS | changes))
        await cycles(self.dut, 20)

    async def read(self, name):
        value = await self.host.read_word(WORD[name])
        await cycles(self.dut, 1)
        return value

    async def write(self, name, value):
        await self.host.write_word(WORD[name], value)
        await cycles(self.dut, 1)

    async def commit(self, table):
        """Writes and commits it, and waits until it has been checked."""
        await table.write(self.host)
        await cycles(self.dut, 100)

    async def errors(self):
        found = errors_of(await self.read("error"))
        coverage.seen("error bit", *found)
        return found

    async def rows(self, planes):
        """What the sequencer reads."""
        dut = self.dut
        found = []
        for plane in range(planes):
            row = []
            for column in range(4):
                dut.table_plane.value, dut.table_column.value = plane, column
                await pulse(dut, dut.table_read)
                row.append(int(dut.table_data.value))
            found.append(Plane(*row))
        return found

    async def assert_in_use(self, table):
        used = {name: int(getattr(self.dut, output).value) for name, output in OUTPUTS.items()}
        words = dict(zip(["planes", "shape", "period_us", "exposure_us", "flyback_us", "trigger_width_us",
                          "opto_on_us", "opto_off_us"], table.words()))
        assert used == {name: (DEFAULT | words)[name] for name in OUTPUTS}
        assert int(self.dut.sweep_lead.value) == table.lead_us
        assert (int(self.dut.sweep_triangle.value), int(self.dut.pulse_active_low.value)) == (table.triangle, table.active_low)
        assert await self.rows(len(table.planes)) == table.planes


@cocotb.test()
async def committed_table_is_in_use_at_rest(dut):
    rig = Rig(dut)
    await rig.begin()
    for table in (table_of(1, 2), table_of(2, 7, triangle=True, flyback_us=30),
                  table_of(3, 3, active_low=True, opto_on_us=4, opto_off_us=9)):
        await rig.commit(table)
        await rig.assert_in_use(table)
        assert await rig.errors() == set()


@cocotb.test()
async def committed_table_waits_for_the_end_of_the_sweep(dut):
    rig = Rig(dut)
    await rig.begin()
    first, second = table_of(4, 3), table_of(5, 4)
    await rig.commit(first)
    dut.idle.value = 0
    await rig.commit(second)
    assert await rig.read("status") & BIT["status.commit_pending"]
    await rig.assert_in_use(first)
    await pulse(dut, dut.progress_boundary)
    await cycles(dut, 2)
    await rig.assert_in_use(second)
    assert not await rig.read("status") & BIT["status.commit_pending"]


@cocotb.test()
async def new_polarity_waits_for_rest(dut):
    rig = Rig(dut)
    await rig.begin()
    await rig.commit(table_of(4, 3))
    dut.idle.value = 0
    await rig.commit(table_of(5, 3, active_low=True))
    await pulse(dut, dut.progress_boundary)
    await cycles(dut, 100)
    assert int(dut.pulse_active_low.value) == 0
    dut.idle.value = 1
    await cycles(dut, 10)
    assert int(dut.pulse_active_low.value) == 1


@cocotb.test()
async def refused_table_leaves_the_one_in_use(dut):
    rig = Rig(dut)
    await rig.begin()
    good = table_of(6, 3)
    await rig.commit(good)
    code, settle, planes = table_of(7, 4), table_of(7, 4), table_of(7, 4)
    code.planes[2].code_a = 1024
    settle.planes[1].settle_us = 900
    planes.planes = planes.planes[:1]
    for table, name, plane in ((code, "table_code", 2), (settle, "table_timing", 1), (planes, "table_planes", 0)):
        await rig.commit(table)
        assert int(dut.error.value) == 1
        assert await rig.errors() == {name}
        assert await rig.read("error_plane") == plane
        await rig.assert_in_use(good)
        await rig.write("error", 0xFFFF)
        assert int(dut.error.value) == 0


@cocotb.test()
async def lead_that_leaves_the_lens_no_time_is_refused(dut):
    """The delays of the opto-isolator are checked in the polarity that is committed."""
    rig = Rig(dut)
    await rig.begin()
    for active_low, opto_on, opto_off in ((False, 200, 0), (True, 0, 200)):
        await rig.commit(table_of(1, 2, active_low=active_low, opto_on_us=opto_on, opto_off_us=opto_off))
        assert await rig.errors() == {"table_timing"}
        await rig.write("error", 0xFFFF)
        await rig.commit(table_of(1, 2, active_low=not active_low, opto_on_us=opto_on, opto_off_us=opto_off,
                       trigger_width_us=300))
        assert await rig.errors() == set()


@cocotb.test()
async def host_reads_back_the_rows_it_wrote(dut):
    rig = Rig(dut)
    await rig.begin()
    table = table_of(8, 64)
    await table.write(rig.host, commit=False)
    for plane in (0, 17, 63):
        await rig.write("plane_select", plane)
        row = [await rig.read(f"plane_{name}") for name in ("code_a", "delay_us", "code_b", "settle_us")]
        assert Plane(*row) == table.planes[plane]


@cocotb.test()
async def sweep_goes_when_told_and_stops_with_a_fault(dut):
    rig = Rig(dut)
    await rig.begin()
    await rig.commit(table_of(9, 2))
    await rig.write("control", BIT["control.enable"] | BIT["control.gated"])
    await cycles(dut, 10)
    assert int(dut.go.value) == 0
    dut.run.value = 1
    await cycles(dut, 10)
    assert int(dut.go.value) == 1
    dut.progress_plane.value = 1
    for number, name in enumerate(["lens_nack", "lens_stretch", "lens_stuck", "lens_arbitration", "late"]):
        dut.sweep_faults.value = 1 << number
        await cycles(dut, 1)
        dut.sweep_faults.value = 0
        await cycles(dut, 2)
        assert (int(dut.go.value), int(dut.error.value)) == (0, 1)
        assert await rig.errors() == {name}
        assert await rig.read("error_plane") == 1
        await rig.write("error", 0xFFFF)
        await cycles(dut, 2)
        assert (int(dut.go.value), int(dut.error.value)) == (1, 0)


@cocotb.test()
async def host_sees_the_sweep(dut):
    rig = Rig(dut)
    await rig.begin(progress_busy=1, progress_plane=33, progress_downward=1)
    status = await rig.read("status")
    assert status >> 6 == 33
    assert status & BIT["status.busy"] and status & BIT["status.downward"]
    for _ in range(3):
        await pulse(dut, dut.progress_fire_sync)
        for _ in range(2):
            await pulse(dut, dut.progress_fire)
            await cycles(dut, 1)
    assert (await rig.read("sweep_count_low"), await rig.read("frame_count_low")) == (3, 6)


@cocotb.test()
async def reset_forgets_the_table(dut):
    rig = Rig(dut)
    await rig.begin()
    await rig.commit(table_of(9, 2))
    await rig.write("control", BIT["control.enable"])
    await cycles(dut, 10)
    assert int(dut.go.value) == 1
    await rig.begin()
    assert int(dut.go.value) == 0
    assert int(dut.sweep_period.value) == DEFAULT["period_us"]
    assert not await rig.read("status") & BIT["status.table_valid"]
