# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""plane_table: the staged copy, the check, and the exchange between two sweeps."""

import random

import cocotb

import coverage
from entity import begin, collect, cycles, drive, pulse

LENS_GAP, LENS_STAGE = 293, 147
CHECKED = dict(planes=2, period=1000, exposure=500, width=100, lead=0, trail=0, new_level=0)
INPUTS = dict(host_plane=0, host_column=0, host_write=0, host_data=0, host_read=0, commit=0, idle=0, boundary=0,
              table_plane=0, table_column=0, table_read=0)


def check(dut, **words):
    """The committed words, from now on."""
    drive(dut, **{f"checked_{word}": value for word, value in words.items()})


async def start(dut, idle=0, **changes):
    check(dut, **(CHECKED | changes))
    await begin(dut, **(INPUTS | dict(idle=idle)))
    coverage.watch("plane_table", dut.dut.state)


async def write_rows(dut, rows):
    for plane, row in enumerate(rows):
        for column, value in enumerate(row):
            dut.host_plane.value, dut.host_column.value, dut.host_data.value = plane, column, value
            await pulse(dut, dut.host_write)


async def read_staged(dut, plane, column):
    dut.host_plane.value, dut.host_column.value = plane, column
    await pulse(dut, dut.host_read)
    return int(dut.host_q.value)


async def read_used(dut, plane, column):
    dut.table_plane.value, dut.table_column.value = plane, column
    await pulse(dut, dut.table_read)
    return int(dut.table_data.value)


async def used_rows(dut, planes):
    return [[await read_used(dut, plane, column) for column in range(4)] for plane in range(planes)]


async def commit(dut):
    """Gives the faults as {name: plane}."""
    found = {name: collect(dut, getattr(dut, f"bad_{name}"), dut.bad_plane) for name in ("planes", "timing", "code")}
    await pulse(dut, dut.commit)
    await cycles(dut, 300)
    return {name: events[0][1] for name, events in found.items() if events}


def rows_of(rng, planes):
    return [[rng.randrange(1024), rng.randrange(100), rng.randrange(1024), rng.randrange(100)] for _ in range(planes)]


@cocotb.test()
async def committed_table_is_used_at_once_when_idle(dut):
    rng = random.Random(7)
    await start(dut, idle=1)
    for planes in (2, 5, 64):
        rows = rows_of(rng, planes)
        check(dut, planes=planes)
        await write_rows(dut, rows)
        assert await read_staged(dut, planes - 1, 2) == rows[-1][2]
        applies = collect(dut, dut.apply)
        assert await commit(dut) == {}
        assert len(applies) == 1 and int(dut.pending.value) == 0
        assert await used_rows(dut, planes) == rows


@cocotb.test()
async def committed_table_waits_for_the_end_of_the_sweep(dut):
    rng = random.Random(8)
    old, new = rows_of(rng, 3), rows_of(rng, 3)
    await start(dut, idle=1, planes=3)
    await write_rows(dut, old)
    await commit(dut)
    dut.idle.value = 0
    await write_rows(dut, new)
    assert await used_rows(dut, 3) == old, "used before commit"
    await commit(dut)
    assert int(dut.pending.value) == 1
    assert await used_rows(dut, 3) == old, "used before the end of the sweep"
    await write_rows(dut, rows_of(rng, 3))
    await pulse(dut, dut.boundary)
    await cycles(dut, 2)
    assert int(dut.pending.value) == 0
    assert await used_rows(dut, 3) == new, "written after commit and used"
    await pulse(dut, dut.boundary)
    await cycles(dut, 2)
    assert await used_rows(dut, 3) == new, "the end of a sweep without a commit"


@cocotb.test()
async def new_polarity_waits_for_idle(dut):
    await start(dut, planes=2, new_level=1)
    await write_rows(dut, [[1, 2, 3, 4]] * 2)
    await commit(dut)
    await pulse(dut, dut.boundary)
    await cycles(dut, 3)
    assert int(dut.pending.value) == 1
    dut.idle.value = 1
    await cycles(dut, 3)
    assert int(dut.pending.value) == 0


@cocotb.test()
async def later_commit_replaces_the_one_that_waits(dut):
    await start(dut, planes=2)
    await write_rows(dut, [[1, 2, 3, 4]] * 2)
    await commit(dut)
    await write_rows(dut, [[5, 6, 7, 8]] * 2)
    await pulse(dut, dut.commit)
    await pulse(dut, dut.boundary)
    await cycles(dut, 3)
    assert int(dut.pending.value) == 0
    await cycles(dut, 50)
    assert int(dut.pending.value) == 1
    await pulse(dut, dut.boundary)
    await cycles(dut, 3)
    assert await used_rows(dut, 2) == [[5, 6, 7, 8]] * 2


@cocotb.test()
async def limits_of_the_settings(dut):
    cases = [({"planes": 2}, None), ({"planes": 64}, None), ({"planes": 1}, "planes"), ({"planes": 0}, "planes"),
             ({"planes": 65}, "planes"), ({"planes": 0xFFFF}, "planes"), ({"planes": 130}, "planes"),
             ({"exposure": LENS_STAGE, "width": 5}, None),
             ({"exposure": LENS_STAGE - 1, "width": 5}, "timing"),
             ({"width": 0}, "timing"), ({"width": 500}, None), ({"width": 501}, "timing"),
             ({"period": 500 + LENS_GAP}, None), ({"period": 500 + LENS_GAP - 1}, "timing"),
             ({"period": 500}, "timing"), ({"period": 10}, "timing"), ({"period": 65535, "exposure": 60000}, None),
             ({"trail": 99}, None), ({"trail": 100}, "timing"), ({"trail": 109, "lead": 10}, None),
             ({"trail": 110, "lead": 10}, "timing"),
             ({"lead": 207}, None), ({"lead": 208}, "timing")]
    await start(dut, idle=1)
    await write_rows(dut, [[0, 0, 0, 0]] * 64)
    for changes, expected in cases:
        check(dut, **(CHECKED | changes))
        await cycles(dut, 2)
        assert list(await commit(dut)) == ([expected] if expected else []), changes


@cocotb.test()
async def every_plane_is_checked(dut):
    await start(dut, idle=1, planes=9)
    slack = 500 - LENS_GAP
    for bad in range(9):
        for column, value, expected in ((0, 1024, "code"), (2, 0x8000, "code"), (1, slack - 50 + 1, "timing"),
                                        (3, slack - 50 + 1, "timing"), (1, 0xFFFF, "timing"), (3, 0xFFFF, "timing"),
                                        (1, slack - 50, None), (3, slack - 50, None), (0, 1023, None), (2, 1023, None)):
            rows = [[1, 50, 2, 50] for _ in range(9)]
            rows[bad][column] = value
            await write_rows(dut, rows)
            assert await commit(dut) == ({expected: bad} if expected else {}), (bad, column, value)


@cocotb.test()
async def settling_is_at_least_the_lead(dut):
    slack = 500 - LENS_GAP
    await start(dut, idle=1, lead=100)
    await write_rows(dut, [[1, slack - 100, 2, 5]] * 2)
    assert await commit(dut) == {}
    await write_rows(dut, [[1, slack - 100 + 1, 2, 5]] * 2)
    assert await commit(dut) == {"timing": 0}


@cocotb.test()
async def planes_beyond_the_last_are_not_checked(dut):
    await start(dut, idle=1, planes=3)
    await write_rows(dut, [[1, 0, 2, 0]] * 3 + [[0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF]])
    assert await commit(dut) == {}


@cocotb.test()
async def refused_table_is_never_used(dut):
    await start(dut, idle=1)
    await write_rows(dut, [[1, 2, 3, 4]] * 2)
    await commit(dut)
    await write_rows(dut, [[2000, 2, 3, 4]] * 2)
    assert await commit(dut) == {"code": 0}
    await pulse(dut, dut.boundary)
    await cycles(dut, 5)
    assert await used_rows(dut, 2) == [[1, 2, 3, 4]] * 2
    await write_rows(dut, [[9, 8, 7, 6]] * 2)
    assert await commit(dut) == {}
    assert await used_rows(dut, 2) == [[9, 8, 7, 6]] * 2, "a good table after a refused one"
