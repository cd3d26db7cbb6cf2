# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""sweep_sequencer: the order of writes and the times of a slot, with a lens bus that is as slow as the test wants."""

import random

import cocotb
from cocotb.triggers import RisingEdge
from cocotb.utils import get_sim_time

import coverage
from entity import CLOCK_HZ, CLOCK_PS, begin, collect, cycles, cycles_until, pulse

TICK = CLOCK_HZ // 1_000_000
WRITE = 40                      # cycles of a write: 5 us
START, LOW, HIGH, COMMIT = 0x03, 0x04, 0x08, 0x09
ROWS = [[111, 2, 222, 5], [333, 0, 444, 0], [555, 3, 666, 1]]
SWEEP = dict(planes=3, triangle=0, period=80, exposure=40, flyback=0, lead=0)
INPUTS = dict(go=0, driver_address=0x77, driver_direct=0, driver_start=0x0303, driver_stage=0x0804, driver_commit=0x0209, table_data=0,
              lens_done=0, lens_fault=0)


class Rig:
    def __init__(self, dut):
        self.dut, self.rows = dut, ROWS
        self.writes, self.slow, self.faulty = [], {}, set()
        self.fires = collect(dut, dut.progress_fire, dut.progress_plane, dut.progress_downward)
        self.syncs = collect(dut, dut.progress_fire_sync, dut.progress_plane)
        self.boundaries = collect(dut, dut.progress_boundary)
        self.lates = collect(dut, dut.late)
        cocotb.start_soon(self._lens())
        cocotb.start_soon(self._table())
        coverage.watch("sweep_sequencer", dut.dut.state)

    def renew(self, rows, slow, faulty):
        """Forgets what was; for tests that start more than once."""
        self.rows, self.slow, self.faulty = rows, slow or {}, set(faulty)
        for record in (self.writes, self.fires, self.syncs, self.boundaries, self.lates):
            record.clear()

    async def _lens(self):
        """Answers each write after WRITE cycles, or as many as `slow` says for it; `faulty` writes fail."""
        while True:
            await RisingEdge(self.dut.lens_start)
            cocotb.start_soon(self._answer(get_sim_time("ps"), len(self.writes)))

    async def _answer(self, time, number):
        await cycles(self.dut, 1)
        self.writes.append((time, int(self.dut.lens_register.value), int(self.dut.lens_value.value)))
        await cycles(self.dut, self.slow.get(number, WRITE) - 1)
        self.dut.lens_fault.value = int(number in self.faulty)
        await pulse(self.dut, self.dut.lens_done)
        self.dut.lens_fault.value = 0

    async def _table(self):
        while True:
            await RisingEdge(self.dut.table_read)
            while int(self.dut.table_read.value):
                plane, column = int(self.dut.table_plane.value), int(self.dut.table_column.value)
                await RisingEdge(self.dut.clk)
                self.dut.table_data.value = self.rows[plane][column]
                await cycles(self.dut, 1)

    def codes(self):
        """Codes committed, from the writes."""
        low = high = None
        found = []
        for _, register, value in self.writes:
            if register == LOW:
                low = value >> 6
            elif register == HIGH:
                high = value
            elif register == COMMIT:
                found.append(high << 2 | low)
        return found

    def intervals(self, events):
        return [(after[0] - before[0]) // CLOCK_PS for before, after in zip(events, events[1:])]

    async def rest(self, limit=2000):
        await cycles_until(self.dut, self.dut.progress_busy, 0, limit)
        await cycles(self.dut, 1000)
        assert int(self.dut.progress_busy.value) == 0



async def started(dut, rows=ROWS, slow=None, faulty=(), rig=None, direct=0, **changes):
    await begin(dut, **(INPUTS | dict(driver_direct=direct)), **{f"sweep_{word}": value for word, value in (SWEEP | changes).items()})
    rig = rig or Rig(dut)
    rig.renew(rows, slow, faulty)
    dut.go.value = 1
    return rig


async def until_fires(rig, count, limit=20_000):
    for _ in range(limit):
        if len(rig.fires) >= count:
            return
        await cycles(rig.dut, 1)
    raise AssertionError(f"{len(rig.fires)} of {count} triggers in {limit} cycles")


@cocotb.test()
async def codes_are_staged_and_committed_in_order(dut):
    rig = await started(dut)
    await until_fires(rig, 3)
    assert [write[1] for write in rig.writes][:9] == [START, LOW, HIGH, COMMIT, LOW, HIGH, COMMIT, LOW, HIGH]
    assert rig.writes[0][2] == 0x03 and rig.writes[3][2] == 0x02
    assert rig.codes() == [111, 222, 333, 444, 555, 666]


@cocotb.test()
async def driver_that_takes_a_code_in_one_write_gets_it_in_place_of_the_commit(dut):
    rows = [[111, 2, 222, 5], [333, 0, 444, 0], [555, 3, 666, 25]]
    rig = await started(dut, rows, direct=1, flyback=9)
    await until_fires(rig, 7)
    await cycles(dut, 1)
    assert rig.writes[0][1:] == (START, 0x03)
    codes = [code for row in rows for code in (row[0], row[2])]
    assert [write[1:] for write in rig.writes[1:15]] == [(HIGH, code >> 2) for code in (codes * 3)[:14]]
    # Code A begins the slot, code B follows it after the delay; nothing is written in an exposure
    slots = [rig.writes[1][0] + (80 * slot + 9 * ((slot + 2) // 3)) * TICK * CLOCK_PS for slot in range(7)]
    assert [round(time) for time, _, _ in rig.writes[1:15:2]] == [round(slot) for slot in slots]
    for slot in range(7):
        delay = (rig.writes[2 + 2 * slot][0] - rig.writes[1 + 2 * slot][0]) // CLOCK_PS - WRITE
        assert rows[slot % 3][1] * TICK <= delay <= rows[slot % 3][1] * TICK + 3
    assert [fire[1] for fire in rig.fires] == [0, 1, 2, 0, 1, 2, 0] and not rig.lates


@cocotb.test()
async def slow_driver_of_one_write_stops_before_the_trigger(dut):
    """Write 2 is code B of the first plane."""
    rig = await started(dut, direct=1, slow={2: WRITE + 300})
    await cycles_until(dut, dut.late, 1, 2000)
    dut.go.value = 0
    await rig.rest(4000)
    assert not rig.fires and len(rig.lates) == 1


@cocotb.test()
async def slots_have_the_period(dut):
    rig = await started(dut)
    await until_fires(rig, 10)
    assert set(rig.intervals(rig.fires)) == {80 * TICK}
    assert [fire[1] for fire in rig.fires] == [0, 1, 2, 0, 1, 2, 0, 1, 2, 0]
    assert rig.syncs == [(time, 0) for time, plane, _ in rig.fires if plane == 0]
    assert rig.intervals(rig.boundaries) == [3 * 80 * TICK] * 2
    # The first slot begins with the first commit; its lens_start is up with the start
    assert rig.fires[0][0] - rig.writes[3][0] == (40 * TICK + 1) * CLOCK_PS


@cocotb.test()
async def next_code_is_staged_in_the_exposure(dut):
    rig = await started(dut)
    await until_fires(rig, 2)
    stage = [time for time, register, _ in rig.writes if register == LOW and time > rig.fires[0][0]][0]
    assert (stage - rig.fires[0][0]) // CLOCK_PS < 20


@cocotb.test()
async def delay_and_settling_are_kept(dut):
    rows = [[1, 6, 2, 9], [3, 0, 4, 14]]
    rig = await started(dut, rows, planes=2)
    await until_fires(rig, 4)
    commits = [time for time, register, _ in rig.writes if register == COMMIT]
    stages = [time for time, register, _ in rig.writes if register == LOW]
    for number, row in enumerate(rows):
        delay = (stages[2 * number + 1] - commits[2 * number]) // CLOCK_PS - WRITE
        assert row[1] * TICK <= delay <= row[1] * TICK + 3
        assert rig.fires[number][0] - commits[2 * number + 1] >= (row[3] * TICK + WRITE) * CLOCK_PS


@cocotb.test()
async def triangle_turns_at_both_ends(dut):
    rig = await started(dut, triangle=1, flyback=7)
    await until_fires(rig, 9)
    assert [fire[1] for fire in rig.fires] == [0, 1, 2, 2, 1, 0, 0, 1, 2]
    assert [fire[2] for fire in rig.fires] == [0, 0, 0, 1, 1, 1, 0, 0, 0]
    assert [plane for _, plane in rig.syncs] == [0, 2, 0]
    assert set(rig.intervals(rig.fires)) == {80 * TICK}, "flyback within a triangle"
    assert rig.codes()[:12] == [111, 222, 333, 444, 555, 666, 555, 666, 333, 444, 111, 222]


@cocotb.test()
async def flyback_lengthens_the_first_slot(dut):
    rig = await started(dut, flyback=33)
    await until_fires(rig, 7)
    assert rig.intervals(rig.fires) == [80 * TICK, 80 * TICK, 113 * TICK] * 2
    assert rig.fires[0][0] - rig.writes[3][0] == (73 * TICK + 1) * CLOCK_PS


@cocotb.test()
async def lead_brings_the_trigger_forward_but_not_sync(dut):
    rig = await started(dut, lead=4)
    await until_fires(rig, 4)
    assert rig.syncs[0][0] - rig.fires[0][0] == 4 * TICK * CLOCK_PS
    assert rig.fires[0][0] - rig.writes[3][0] == (36 * TICK + 1) * CLOCK_PS


@cocotb.test()
async def random_tables_keep_their_times(dut):
    rng = random.Random(9)
    rig = None
    for _ in range(6):
        planes = rng.randrange(2, 6)
        rows = [[rng.randrange(1024), rng.randrange(6), rng.randrange(1024), rng.randrange(6)] for _ in range(planes)]
        period = 80 + rng.randrange(30)
        rig = await started(dut, rows, rig=rig, planes=planes, period=period, exposure=40)
        await until_fires(rig, 2 * planes)
        assert set(rig.intervals(rig.fires)) == {period * TICK}
        assert rig.codes()[:4 * planes] == [code for row in rows for code in (row[0], row[2])] * 2
        dut.go.value = 0
        await rig.rest()


@cocotb.test()
async def slow_lens_stops_before_the_trigger(dut):
    """Write 4 stages code B of the first plane."""
    rig = None
    for extra, good in ((150, True), (260, False), (2000, False)):
        rig = await started(dut, slow={4: WRITE + extra}, rig=rig, period=90, exposure=40)
        if good:
            await until_fires(rig, 2)
            assert not rig.lates
        else:
            await cycles_until(dut, dut.late, 1, 2000)
            dut.go.value = 0
            await rig.rest(4000)
            assert not rig.fires and len(rig.lates) == 1
        dut.go.value = 0
        await rig.rest(4000)


@cocotb.test()
async def settling_that_is_not_over_stops_before_the_trigger(dut):
    rows = [[1, 0, 2, 19], [3, 0, 4, 21]]
    rig = await started(dut, rows, planes=2, period=80, exposure=40)
    await cycles_until(dut, dut.late, 1, 4000)
    dut.go.value = 0
    await rig.rest()
    assert len(rig.fires) == 1


@cocotb.test()
async def code_not_staged_by_the_end_of_the_exposure_stops(dut):
    rig = await started(dut, slow={7: 400})
    await cycles_until(dut, dut.late, 1, 4000)
    dut.go.value = 0
    await rig.rest()
    assert len(rig.fires) == 1 and len(rig.lates) == 1


@cocotb.test()
async def fault_of_the_lens_stops_the_sweep(dut):
    """Each of the first ten writes fails once; an exposure that has begun is finished."""
    rig = None
    for number in range(10):
        rig = await started(dut, faulty=[number], rig=rig)
        while len(rig.writes) <= number:
            await cycles(dut, 1)
        await cycles_until(dut, dut.lens_fault, 1, 200)
        await cycles(dut, 2)
        dut.go.value = 0
        fires = len(rig.fires)
        assert fires == (0 if number < 7 else 1)
        await rig.rest()
        assert len(rig.fires) == fires and len(rig.writes) == number + 1
        if fires and number < 9:
            assert not rig.lates


@cocotb.test()
async def stop_at_any_moment_gives_no_further_trigger(dut):
    """An exposure that has begun keeps the sequencer busy until its end."""
    rig = await started(dut)
    for moment in range(7, 700, 31):
        await cycles(dut, moment)
        fires = len(rig.fires)
        assert [fire[1] for fire in rig.fires] == [0, 1, 2][:fires], "does not start with the first plane"
        last = rig.fires[-1][0] if rig.fires else None
        dut.go.value = 0
        await cycles(dut, 2)
        assert len(rig.fires) <= fires + 1
        fires, last = len(rig.fires), rig.fires[-1][0] if rig.fires else last
        ended = await cycles_until(dut, dut.progress_busy, 0, 1000)
        if last and ended > 60:
            assert get_sim_time("ps") - last >= 39 * TICK * CLOCK_PS
        await cycles(dut, 800)
        assert len(rig.fires) == fires and not rig.lates
        rig.fires.clear()
        rig.syncs.clear()
        dut.go.value = 1
    await until_fires(rig, 1)
    assert rig.fires[0][1] == 0 and len(rig.syncs) == 1, "does not start with the first plane"


@cocotb.test()
async def reset_ends_everything(dut):
    rig = await started(dut)
    await until_fires(rig, 2)
    dut.reset.value = 1
    await cycles(dut, 1)
    assert int(dut.progress_busy.value) == 0 and int(dut.lens_start.value) == 0
    dut.go.value = 0
    dut.reset.value = 0
    await cycles(dut, 1000)
    assert len(rig.fires) == 2
