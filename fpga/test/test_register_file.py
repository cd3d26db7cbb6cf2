# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""register_file: every word, staging, errors, counters."""

import random

import cocotb

from entity import begin, collect, cycles, pulse
from words import BIT, DEFAULT, ERRORS, MASK, REGISTERS, STAGED, WORD, WRITABLE

IDLE = {name: 0 for name in ("word_number", "read", "write", "write_data", "table_q", "pending", "apply", "run",
                             "progress_busy", "progress_downward", "progress_plane", "progress_fire_sync",
                             "progress_fire", "progress_boundary", "sweep_faults", "table_faults", "table_fault_plane")}
SELECTORS = {"plane_code_a", "plane_delay_us", "plane_code_b", "plane_settle_us"}


async def write(dut, name, value):
    dut.word_number.value = WORD[name]
    dut.write_data.value = value
    await pulse(dut, dut.write)
    await cycles(dut, 1)


async def read(dut, number):
    """As the slave does: data four cycles after read."""
    dut.word_number.value = WORD[number] if isinstance(number, str) else number
    await cycles(dut, 2)
    await pulse(dut, dut.read)
    await cycles(dut, 3)
    return int(dut.read_data.value)


async def apply(dut):
    await write(dut, "commit", 1)
    await cycles(dut, 2)
    await pulse(dut, dut.apply)
    await cycles(dut, 2)


@cocotb.test()
async def words_after_reset(dut):
    await begin(dut, **IDLE)
    for register in REGISTERS:
        if register.name in SELECTORS | {"lens_gap_us", "lens_stage_us"}:
            continue
        assert await read(dut, register.name) == DEFAULT[register.name], register.name
    assert await read(dut, "lens_gap_us") == 293
    assert await read(dut, "lens_stage_us") == 147
    for number in (len(REGISTERS), 127):
        assert await read(dut, number) == 0xFFFF


@cocotb.test()
async def writable_tells_the_words_that_can_be_written(dut):
    await begin(dut, **IDLE)
    for number in range(128):
        dut.word_number.value = number
        await cycles(dut, 2)
        expected = number < len(REGISTERS) and REGISTERS[number].name in WRITABLE
        assert int(dut.writable.value) == expected, number


@cocotb.test()
async def staged_words_keep_their_bits_and_wait_for_apply(dut):
    rng = random.Random(4)
    await begin(dut, **IDLE)
    outputs = {"period_us": "sweep_period", "exposure_us": "sweep_exposure", "flyback_us": "sweep_flyback",
               "trigger_width_us": "pulse_width", "opto_on_us": "pulse_opto_on", "opto_off_us": "pulse_opto_off",
               "lens_start": "driver_start", "lens_stage": "driver_stage", "lens_commit": "driver_commit"}
    checked = {"period_us": "checked_period", "exposure_us": "checked_exposure", "planes": "checked_planes",
               "trigger_width_us": "checked_width"}
    used = dict(DEFAULT)
    for _ in range(4):
        values = {name: rng.randrange(0x10000) for name in STAGED}
        for name, value in values.items():
            await write(dut, name, value)
        for name, value in values.items():
            assert await read(dut, name) == value & MASK[name], name
        for name, output in outputs.items():
            assert int(getattr(dut, output).value) == used[name], f"{name} is in use before it was applied"
        await write(dut, "commit", 0)
        assert int(dut.checked_period.value) == used["period_us"], "a 0 written to commit commits"
        await write(dut, "commit", 1)
        await cycles(dut, 2)
        for name, output in checked.items():
            assert int(getattr(dut, output).value) == values[name] & MASK[name]
        for name in STAGED:
            await write(dut, name, 0)
        await pulse(dut, dut.apply)
        await cycles(dut, 2)
        used = {name: value & MASK[name] for name, value in values.items()}
        for name, output in outputs.items():
            assert int(getattr(dut, output).value) == used[name], name
        assert int(dut.driver_address.value) == used["lens_address"] & 0x7F
        assert int(dut.driver_direct.value) == bool(used["lens_address"] & BIT["lens_address.direct"])
        assert int(dut.sweep_planes.value) == used["planes"] & 0x7F
        assert int(dut.sweep_triangle.value) == bool(used["shape"] & BIT["shape.triangle"])
        low = bool(used["shape"] & BIT["shape.trigger_active_low"])
        assert int(dut.pulse_active_low.value) == low
        lead, trail = (("opto_off_us", "opto_on_us") if low else ("opto_on_us", "opto_off_us"))
        assert int(dut.sweep_lead.value) == int(dut.checked_lead.value) == used[lead]
        assert int(dut.checked_trail.value) == used[trail]


@cocotb.test()
async def new_polarity_is_told(dut):
    await begin(dut, **IDLE)
    await write(dut, "shape", BIT["shape.trigger_active_low"])
    assert int(dut.checked_new_level.value) == 0
    await write(dut, "commit", 1)
    await cycles(dut, 2)
    assert int(dut.checked_new_level.value) == 1
    await pulse(dut, dut.apply)
    await cycles(dut, 2)
    assert int(dut.checked_new_level.value) == 0


@cocotb.test()
async def go_needs_everything(dut):
    await begin(dut, **IDLE)

    async def go():
        await cycles(dut, 3)
        return int(dut.go.value)

    await write(dut, "control", BIT["control.enable"])
    assert not await go(), "without a table"
    await apply(dut)
    assert await go()
    assert await read(dut, "status") & BIT["status.table_valid"]
    await write(dut, "control", BIT["control.gated"])
    dut.run.value = 1
    assert not await go(), "without enable"
    await write(dut, "control", BIT["control.gated"] | BIT["control.enable"])
    assert await go()
    dut.run.value = 0
    assert not await go(), "without run"
    dut.run.value = 1
    dut.sweep_faults.value = 1
    await cycles(dut, 1)
    dut.sweep_faults.value = 0
    assert not await go(), "with an error"
    await write(dut, "error", 1)
    assert await go()


@cocotb.test()
async def errors_stay_until_cleared(dut):
    await begin(dut, **IDLE)
    for number, name in enumerate(ERRORS):
        await write(dut, "error", 0xFFFF)
        assert int(dut.error.value) == 0
        dut.progress_plane.value, dut.table_fault_plane.value = 10 + number, 40 + number
        faults = dut.sweep_faults if number < 5 else dut.table_faults
        faults.value = 1 << (number if number < 5 else number - 5)
        await cycles(dut, 1)
        faults.value = 0
        await cycles(dut, 2)
        dut.progress_plane.value = dut.table_fault_plane.value = 0
        assert int(dut.error.value) == 1
        assert await read(dut, "error") == BIT[f"error.{name}"]
        assert await read(dut, "error_plane") == (10 if number < 5 else 40) + number
        await write(dut, "error", 0xFFFF ^ BIT[f"error.{name}"])
        assert await read(dut, "error") == BIT[f"error.{name}"], "cleared by a 0"
        assert await read(dut, "status") & BIT["status.failed"]


@cocotb.test()
async def second_error_keeps_the_plane_of_the_first(dut):
    await begin(dut, **IDLE)
    for plane, fault in ((7, 1), (9, 16)):
        dut.progress_plane.value = plane
        dut.sweep_faults.value = fault
        await cycles(dut, 1)
        dut.sweep_faults.value = 0
        await cycles(dut, 1)
    assert await read(dut, "error") == 0b10001
    assert await read(dut, "error_plane") == 7


@cocotb.test()
async def error_raised_while_it_is_cleared_stays(dut):
    await begin(dut, **IDLE)
    dut.word_number.value = WORD["error"]
    dut.write_data.value = 0xFFFF
    dut.sweep_faults.value = 2
    await pulse(dut, dut.write)
    dut.sweep_faults.value = 0
    assert await read(dut, "error") == 2


@cocotb.test()
async def counters_have_32_bits_and_latch_the_high_word(dut):
    await begin(dut, **IDLE)
    for name, strobe in (("sweep", dut.progress_fire_sync), ("frame", dut.progress_fire)):
        strobe.value = 1
        await cycles(dut, 0x1_0003)
        strobe.value = 0
        assert await read(dut, f"{name}_count_low") == 3
        await cycles(dut, 1)
        assert await read(dut, f"{name}_count_high") == 1
        assert await read(dut, f"{name}_count_low") == 3
        strobe.value = 1
        await cycles(dut, 0xFFFF)
        strobe.value = 0
        assert await read(dut, f"{name}_count_high") == 1, "the high word moved after the low one was read"
        assert await read(dut, f"{name}_count_low") == 2
        assert await read(dut, f"{name}_count_high") == 2


@cocotb.test()
async def status_shows_the_inputs(dut):
    await begin(dut, **IDLE)
    for name, signal in (("busy", dut.progress_busy), ("downward", dut.progress_downward), ("commit_pending", dut.pending),
                         ("run", dut.run)):
        signal.value = 1
        assert await read(dut, "status") == BIT[f"status.{name}"]
        signal.value = 0
    dut.progress_plane.value = 0b101011
    assert await read(dut, "status") == 0b101011 << 6


@cocotb.test()
async def window_leads_to_the_row(dut):
    await begin(dut, **IDLE)
    writes = collect(dut, dut.table_write, dut.table_plane, dut.table_column, dut.table_data)
    reads = collect(dut, dut.table_read)
    for column, name in enumerate(["plane_code_a", "plane_delay_us", "plane_code_b", "plane_settle_us"]):
        await write(dut, "plane_select", 60 + column)
        assert await read(dut, "plane_select") == 60 + column
        await write(dut, name, 0x5500 + column)
        dut.table_q.value = 0x6600 + column
        assert await read(dut, name) == 0x6600 + column
        assert int(dut.table_column.value) == column
    assert [row[1:] for row in writes] == [(60 + column, column, 0x5500 + column) for column in range(4)]
    assert len(reads) >= 4


@cocotb.test()
async def words_that_are_read_only_do_not_change(dut):
    await begin(dut, **IDLE)
    for register in REGISTERS:
        if register.name not in WRITABLE:
            before = await read(dut, register.name)
            await write(dut, register.name, 0xFFFF ^ before)
            assert await read(dut, register.name) == before, register.name
