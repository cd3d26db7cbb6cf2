# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The chain from the host's bus to the lens and the trigger, against the model, to the clock."""

import os

import cocotb
from cocotb.triggers import Timer
from cocotb.utils import get_sim_time

from bench import BIT_CYCLES, CLOCK_HZ, CLOCK_PS, SCALE, TICK_CYCLES, Bench
from sweep_model import Plane, Table, expect
from words import WORD

SWEEPS = int(os.environ.get("BENCH_SWEEPS", 1))
# The sweep of the paper: 156.25 frames/s, 6 ms of exposure, 38.4 ms. 109 us remain for delay and settling at 125 MHz.
PAPER = [Plane(100 + 90 * number, 9, 80 + 100 * number, 90) for number in range(6)]


@cocotb.test()
async def sweeps_follow_the_table_to_the_clock(dut):
    bench = Bench(dut)
    await bench.reset()
    table = Table(PAPER)
    assert await bench.host.read_word(WORD["identity"]) == 0xDFF5
    await table.write(bench.host)
    await bench.control("enable")
    await bench.until_triggers(6 * SWEEPS, (SWEEPS + 1) * 38_400)
    await bench.wait_us(1_000)
    bench.check(table, expect(table, SWEEPS, TICK_CYCLES, BIT_CYCLES))
    assert await bench.errors() == set()
    assert await bench.count("frame") == 6 * SWEEPS
    assert await bench.count("sweep") == SWEEPS

    starts = bench.trigger_starts()
    offsets = {tuple(time - starts[first] for time in starts[first:first + 6]) for first in range(0, len(starts), 6)}
    assert len(offsets) == 1, "the trigger jitters between sweeps"
    sweep_us = 38_400 * TICK_CYCLES * CLOCK_PS
    assert all(starts[number + 6] - starts[number] == sweep_us for number in range(len(starts) - 6))
    report_budget(bench, table, starts)


@cocotb.test(skip="BENCH_ONE_PLANE" not in os.environ)
async def one_plane_at_the_real_clock(dut):
    """The first plane of the paper's table, at a board's clock. A pulse on `run` that the filter drops does not start it."""
    bench = Bench(dut)
    await bench.reset()
    table = Table(PAPER, period_us=700, exposure_us=300, trigger_width_us=20)
    await table.write(bench.host)
    await bench.control("enable", "gated")
    if CLOCK_PS < 50_000:  # the filter is longer than a clock
        dut.run.value = 1
        await Timer(CLOCK_PS, unit="ps")
        dut.run.value = 0
        await bench.wait_us(2)
        assert int(dut.busy.value) == 0, "a pulse of one clock starts the sweep"
    dut.run.value = 1
    await bench.until_triggers(1, 2_000)
    await bench.wait_us(50)
    expected = expect(table, 1, TICK_CYCLES, BIT_CYCLES)
    bench.check(table, type(expected)(expected.trigger[:1], expected.sync[:1], expected.codes[:2]))
    report_budget(bench, table, bench.trigger_starts())


def report_budget(bench, table, starts):
    """The gap between two exposures, as measured."""
    unit = TICK_CYCLES * CLOCK_PS
    slot = starts[0] - (table.period_us - table.exposure_us) * unit
    a, b = bench.lens.codes[0][0], bench.lens.codes[1][0]
    plane = table.planes[0]
    cocotb.log.info(
        "budget of the %d us gap at CLOCK_HZ=%d SCALE=%d: commit A %.1f us, delay %d us, stage and commit B %.1f us, "
        "settle %d us, to spare %.1f us", table.period_us - table.exposure_us, CLOCK_HZ, SCALE, (a - slot) / unit,
        plane.delay_us, (b - a) / unit - plane.delay_us, plane.settle_us, (starts[0] - b) / unit - plane.settle_us)
    cocotb.log.info("simulated until %.1f us", get_sim_time("us"))
