# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""synchronizer: at 125 MHz 50 ns are 7 cycles."""

import cocotb

from entity import begin, collect, cycles, cycles_until

GLITCH_CYCLES = 7
LATENCY = 2 + GLITCH_CYCLES


@cocotb.test()
async def level_follows_after_the_filter(dut):
    await begin(dut, async_in=1)
    await cycles(dut, 20)
    assert int(dut.sync_out.value) == 1
    for level in (0, 1, 0):
        dut.async_in.value = level
        assert await cycles_until(dut, dut.sync_out, level, 50) == LATENCY
        await cycles(dut, 20)
        assert int(dut.sync_out.value) == level


@cocotb.test()
async def short_pulses_are_dropped(dut):
    await begin(dut, async_in=1)
    await cycles(dut, 20)
    rises = collect(dut, dut.sync_out)
    for length in range(1, GLITCH_CYCLES):
        dut.async_in.value = 0
        await cycles(dut, length)
        dut.async_in.value = 1
        await cycles(dut, 2)
        dut.async_in.value = 0
        await cycles(dut, 1)
        dut.async_in.value = 1
        await cycles(dut, 30)
        assert int(dut.sync_out.value) == 1
    assert not rises, "a glitch passed"
    dut.async_in.value = 0
    await cycles(dut, GLITCH_CYCLES)
    dut.async_in.value = 1
    await cycles(dut, 30)
    assert len(rises) == 1, "a pulse of full length did not pass"


@cocotb.test()
async def reset_gives_the_reset_level(dut):
    await begin(dut, async_in=0)
    await cycles(dut, 20)
    assert int(dut.sync_out.value) == 0
    dut.reset.value = 1
    await cycles(dut, 1)
    assert int(dut.sync_out.value) == 1
