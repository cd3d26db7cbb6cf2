# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""slot_timer: the moments of a slot, to the cycle, slot after slot."""

import random

import cocotb
from cocotb.triggers import Timer

from entity import CLOCK_HZ, cycles, drive

TICK = CLOCK_HZ // 1_000_000
WORDS = dict(period=80, flyback=0, exposure=40, lead=0)


async def held(dut, **words):
    drive(dut, running=0, **(WORDS | words))
    await cycles(dut, 3)


async def moments(dut, count):
    """The next `count` cycles; gives those in which each moment was."""
    found = {name: [] for name in ("fire_due", "expose_due", "slot_end")}
    for cycle in range(count):
        await Timer(1, unit="ps")
        for name, times in found.items():
            if int(getattr(dut, name).value):
                times.append(cycle)
        await cycles(dut, 1)
    return found


def expected(period, flyback, exposure, lead):
    expose = period + flyback - exposure
    return {"fire_due": [(expose - lead) * TICK], "expose_due": [expose * TICK],
            "slot_end": [(period + flyback) * TICK - 1]}


@cocotb.test()
async def slots_follow_one_another_to_the_cycle(dut):
    words = WORDS | dict(lead=4)
    await held(dut, **words)
    dut.running.value = 1
    for slot in range(4):
        assert await moments(dut, 80 * TICK) == expected(**words), f"slot {slot}"


@cocotb.test()
async def words_that_change_in_a_slot_count_from_the_next_one(dut):
    rng = random.Random(12)
    words = dict(WORDS)
    await held(dut, **words)
    dut.running.value = 1
    for slot in range(12):
        length, wanted = (words["period"] + words["flyback"]) * TICK, expected(**words)
        change = rng.randrange(1, length)
        words = dict(period=rng.randrange(60, 90), flyback=rng.choice([0, 0, 33]), exposure=rng.randrange(20, 50),
                     lead=rng.randrange(10))
        before = await moments(dut, change)
        drive(dut, **words)
        after = await moments(dut, length - change)
        assert {name: before[name] + [change + cycle for cycle in after[name]] for name in wanted} == wanted, slot


@cocotb.test()
async def held_timer_is_silent_and_begins_with_a_whole_slot(dut):
    await held(dut)
    for moment in (1, 40 * TICK, 40 * TICK + 1, 77 * TICK, 80 * TICK - 1, 80 * TICK):
        dut.running.value = 1
        await moments(dut, moment)
        dut.running.value = 0
        assert not any((await moments(dut, 2 * 80 * TICK)).values()), f"held after {moment} cycles"
        dut.running.value = 1
        assert await moments(dut, 80 * TICK) == expected(**WORDS), f"held after {moment} cycles"
        dut.running.value = 0
        await cycles(dut, 1)
