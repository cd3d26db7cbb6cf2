# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""trigger_output: length and polarity of the pulse, for every pair of delays."""

import random

import cocotb

from entity import CLOCK_HZ, begin, cycles, cycles_until, pulse

TICK = CLOCK_HZ // 1_000_000


async def start(dut, active_low=0, width=5, opto_on=0, opto_off=0):
    await begin(dut, fire=0, active_low=active_low, width=width, opto_on=opto_on, opto_off=opto_off)
    await cycles(dut, 2)


async def measure(dut, active):
    """Fires; gives (latency, length) of the pulse in cycles."""
    dut.fire.value = 1
    await cycles(dut, 1)
    dut.fire.value = 0
    latency = 1 + await cycles_until(dut, dut.pin, active, 10)
    length = await cycles_until(dut, dut.pin, 1 - active, 100_000)
    return latency, length


@cocotb.test()
async def pulse_has_the_width(dut):
    for width in (1, 2, 7, 300):
        await start(dut, width=width)
        assert int(dut.pin.value) == 0
        assert await measure(dut, 1) == (1, width * TICK)
        assert int(dut.active.value) == 0


@cocotb.test()
async def width_behind_the_opto_isolator_is_right_in_both_polarities(dut):
    rng = random.Random(1)
    for _ in range(12):
        active_low, on, off = rng.randrange(2), rng.randrange(60), rng.randrange(60)
        lead, trail = (off, on) if active_low else (on, off)
        width = max(1, trail - lead + 1) + rng.randrange(50)
        await start(dut, active_low, width, on, off)
        assert int(dut.pin.value) == active_low
        _, length = await measure(dut, 1 - active_low)
        assert length - lead * TICK + trail * TICK == width * TICK


@cocotb.test()
async def fire_in_a_pulse_does_not_prolong_it(dut):
    await start(dut, width=4)
    await pulse(dut, dut.fire)
    await cycles(dut, 10)
    await pulse(dut, dut.fire)
    assert await cycles_until(dut, dut.pin, 0, 100) == 4 * TICK - 11
    await cycles(dut, 100)
    assert int(dut.pin.value) == 0


@cocotb.test()
async def settings_may_change_once_the_pulse_has_begun(dut):
    await start(dut, width=6, opto_on=3)
    await pulse(dut, dut.fire)
    dut.width.value = 50
    dut.opto_on.value = 0
    assert await cycles_until(dut, dut.pin, 0, 1000) == 9 * TICK
    assert await measure(dut, 1) == (1, 50 * TICK)


@cocotb.test()
async def reset_ends_the_pulse(dut):
    for active_low in (0, 1):
        await start(dut, active_low=active_low, width=20)
        await pulse(dut, dut.fire)
        await cycles(dut, 3)
        assert int(dut.pin.value) == 1 - active_low
        dut.reset.value = 1
        await cycles(dut, 1)
        assert int(dut.pin.value) == active_low
        assert int(dut.active.value) == 0
