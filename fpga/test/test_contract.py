# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The bytes that the C++ driver sends, recorded by its unit test for each lens driver, give the sweep they were meant to
give; so do the commands of the README, and those of doc/wiring.md for a driver that takes a code in one write."""

import random
import re
from pathlib import Path

import cocotb

from bench import BIT_CYCLES, TICK_CYCLES, Bench
from max14574 import Max14515
from sweep_model import Plane, Table, expect, random_table
from words import DEFAULT, WORD

SWEEPS = 3
TEST = Path(__file__).resolve().parent


# What a code of the table is for what the driver is told: MAX14574, 10 bits over 24.4 to 69.9 V; MAX14515, its own 8 bits
CODES = {"MAX14574": lambda volts: int((float(volts) - 24.4) / 45.5 * 1023 + 0.5),
         "MAX14515": lambda code: 4 * int(code)}


def recording(driver):
    """Of the part for this driver: (the table that was meant, the lines to play)."""
    table, planes, lines, chosen = None, [], [], False
    for line in (TEST / "contract.txt").read_text(encoding="utf-8").splitlines():
        kind, *rest = line.split()
        fields = dict(item.split("=") for item in rest if "=" in item)
        if kind == "table":
            chosen = fields.pop("driver") == driver
        if not chosen:
            continue
        if kind == "table":
            times = {name: int(value) for name, value in fields.items()}
            table = dict(period_us=times["period"], exposure_us=times["exposure"], flyback_us=times["flyback"],
                         trigger_width_us=times["width"], opto_on_us=times["opto_on"], opto_off_us=times["opto_off"])
        elif kind == "plane":
            planes.append(Plane(CODES[driver](fields["a"]), int(fields["delay"]), CODES[driver](fields["b"]),
                                int(fields["settle"])))
        else:
            lines.append((kind, rest))
    return Table(planes, **table), lines


@cocotb.test()
async def recorded_driver_gives_the_sweep_it_meant(dut):
    await play_recording(Bench(dut), "MAX14574")


@cocotb.test()
async def recorded_driver_sweeps_a_max14515(dut):
    bench = Bench(dut, Max14515)
    await play_recording(bench, "MAX14515")
    assert (Max14515.POWER_MODE, Max14515.ON) in {(register, value) for _, register, value in bench.lens.writes}


async def play_recording(bench, driver):
    await bench.reset()
    table, lines = recording(driver)
    seen = []
    for kind, rest in lines:
        if kind == "write":
            await bench.host.write_bytes(bytes.fromhex(rest[0]))
        elif kind == "read":
            low, high = await bench.host.read_bytes(int(rest[0], 16), 2)
            check_read(bench, int(rest[0], 16), high << 8 | low)
        else:
            await expectation(bench, table, " ".join(rest), driver == "MAX14515")
            seen.append(" ".join(rest))
    assert seen == ["rest", "sweeps", "rest", "sweeps with run", "rest"], "the recording is not whole"


def check_read(bench, word, value):
    if word in (WORD["identity"], WORD["version"]):
        assert value == DEFAULT["identity" if word == WORD["identity"] else "version"]
    elif word == WORD["error"]:
        assert value == 0
    elif word == WORD["sweep_count_low"]:
        begun = len([level for _, level in bench.syncs if level])
        assert begun - 1 <= value <= begun, "the sweep goes on while the word is read"


async def expectation(bench, table, what, direct):
    if what == "rest":
        await bench.until(bench.dut.busy, 0, 2_000)
        for record in (bench.triggers, bench.lens.codes):
            record.clear()
        await bench.wait_us(2_000)
        assert not bench.triggers
        return
    syncs = len(bench.syncs)
    if what == "sweeps with run":
        await bench.wait_us(2_000)
        assert not bench.triggers, "sweeps without run"
        bench.dut.run.value = 1
    await bench.until_triggers(SWEEPS * len(table.planes), SWEEPS * 5_000)
    await bench.wait_us(150)
    older, bench.syncs[:] = bench.syncs[:syncs], bench.syncs[syncs:]
    bench.check(table, expect(table, SWEEPS, TICK_CYCLES, BIT_CYCLES, direct))
    bench.syncs[:] = older + bench.syncs


async def play(bench, page):
    """Plays the i2c-tools commands of a page; gives how many there are."""
    commands = re.findall(r"^ *i2c(set|get) -y 1 (\w+) (\w+) (?:(\w+) )?w *(?:# (0x\w+))?",
                          (TEST.parent / page).read_text(encoding="utf-8"), re.MULTILINE)
    for action, address, word, value, answer in commands:
        assert int(address, 0) == bench.host.address
        if action == "set":
            await bench.host.write_word(int(word, 0), int(value, 0))
        else:
            assert await bench.host.read_word(int(word, 0)) == int(answer, 0)
    return len(commands)


@cocotb.test()
async def commands_of_the_wiring_page_sweep_a_driver_of_one_write(dut):
    bench = Bench(dut, Max14515)
    rng = random.Random(8)
    for triangle in (False, True):
        await bench.reset()
        assert await play(bench, "doc/wiring.md") == 3
        table = random_table(rng, 296, 148, planes=4, triangle=triangle)
        await table.write(bench.host)
        await bench.control("enable")
        await bench.until_triggers(3 * len(table.planes), 20_000, active=0 if table.active_low else 1)
        await bench.wait_us(table.lead_us + table.trigger_width_us + 20)
        bench.check(table, expect(table, 3, TICK_CYCLES, BIT_CYCLES, direct=True))
        assert await bench.errors() == set()
        assert {register for _, register, _ in bench.lens.writes} == {Max14515.POWER_MODE, Max14515.VOLTAGE}


@cocotb.test()
async def commands_of_the_readme_give_a_sweep(dut):
    bench = Bench(dut)
    await bench.reset()
    await play(bench, "README.md")
    table = Table([Plane(340, 9, 300, 90), Plane(560, 9, 600, 90)])
    await bench.until_triggers(3, 30_000)
    await bench.wait_us(150)
    bench.check(table, expect(table, 1, TICK_CYCLES, BIT_CYCLES))
