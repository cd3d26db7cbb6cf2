# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The whole chain: random tables against the model, and every fault ends as documented."""

import os
import random

import cocotb
from cocotb.triggers import FallingEdge, RisingEdge

from bench import BIT_CYCLES, CLOCK_PS, TICK_CYCLES, Bench, pulses
from sweep_model import Plane, Table, expect, random_table
from words import BIT, DEFAULT, STAGED, WORD


def short_table(planes=3, **changes):
    """A sweep that is over soon, with 20 us to spare."""
    settings = dict(period_us=296 + 60 + 200, exposure_us=200, trigger_width_us=50) | changes
    return Table([Plane(100 + number, 10, 500 + number, 30) for number in range(planes)], **settings)


async def started(bench, table, *control, fault=lambda lens: None):
    """After a reset, with the table in use and sweeping. fault: what the lens driver will do wrong."""
    await bench.reset()
    fault(bench.lens)
    await table.write(bench.host)
    await bench.control("enable", *control)
    return bench


async def stands_still(bench, triggers):
    """No further trigger, and the sequencer comes to rest."""
    await bench.until(bench.dut.busy, 0, 2_000)
    await bench.wait_us(2_000)
    assert len(bench.trigger_starts()) == triggers, f"{len(bench.trigger_starts())} triggers, not {triggers}"


async def failed_with(bench, error, triggers):
    """Ends in this error bit, with the error pin up and after this many triggers."""
    await bench.until(bench.dut.error, 1, 6_000)
    await stands_still(bench, triggers)
    assert await bench.errors() == {error}
    assert await bench.status("failed")


async def starts_anew(bench, table):
    """Clearing the error starts a whole sweep with plane 0."""
    for record in (bench.triggers, bench.syncs, bench.lens.codes):
        record.clear()
    await bench.clear_errors()
    await bench.until_triggers(len(table.planes), 6_000)
    await bench.wait_us(100)
    bench.check(table, expect(table, 1, TICK_CYCLES, BIT_CYCLES))


@cocotb.test()
async def words_have_their_reset_values(dut):
    bench = Bench(dut)
    await bench.reset()
    for name in ["identity", "version", "control", "error", "sweep_count_low", "plane_select", *STAGED]:
        assert await bench.host.read_word(WORD[name]) == DEFAULT[name], name
    assert await bench.host.read_word(WORD["lens_gap_us"]) == 296
    assert await bench.host.read_word(WORD["lens_stage_us"]) == 148


@cocotb.test()
async def random_tables_sweep_as_the_model_says(dut):
    bench = Bench(dut)
    rng = random.Random(5)
    for round_ in range(int(os.environ.get("BENCH_TABLES", 8))):
        table = random_table(rng, 296, 148, triangle=bool(round_ % 2))
        await started(bench, table)
        await bench.until_triggers(3 * len(table.planes), 20_000, active=0 if table.active_low else 1)
        await bench.wait_us(table.lead_us + table.trigger_width_us + 20)
        bench.check(table, expect(table, 3, TICK_CYCLES, BIT_CYCLES))
        assert await bench.errors() == set()


@cocotb.test()
async def sixty_four_planes_sweep(dut):
    bench = Bench(dut)
    table = short_table(64)
    await started(bench, table)
    await bench.until_triggers(65, 50_000)
    await bench.wait_us(100)
    bench.check(table, expect(table, 1, TICK_CYCLES, BIT_CYCLES))


@cocotb.test()
async def host_traffic_does_not_move_a_trigger(dut):
    bench = Bench(dut)
    table = short_table()
    await started(bench, table)
    rng = random.Random(6)
    while len(bench.trigger_starts()) < 9:
        word = rng.choice(["status", "sweep_count_low", "plane_code_b", "planes", "error"])
        await bench.host.read_word(WORD[word])
        await bench.host.write_words(WORD["plane_select"], [rng.randrange(3), 1, 2, 3, 4])
        await bench.host.read_block(WORD["plane_select"])
    await bench.wait_us(100)
    bench.check(table, expect(table, 3, TICK_CYCLES, BIT_CYCLES))


@cocotb.test()
async def host_that_errs_is_refused_and_one_that_breaks_off_does_not_hold_the_bus(dut):
    bench = Bench(dut)
    await bench.reset()
    host = bench.host
    await host.start()
    assert not await host.send(0x3D << 1), "the address of another slave"
    await host.stop()
    await host.start()
    assert await host.send(host.address << 1) and await host.send(0x80 | WORD["planes"])
    assert not await host.send(3), "a block with an odd count of bytes"
    await host.stop()
    await host.start()
    assert await host.send(host.address << 1) and await host.send(WORD["version"])
    await host.start()
    assert await host.send(host.address << 1 | 1)
    await bench.wait_us(20)
    assert int(dut.host_sda.value) == 0, "the first bit of the word"
    await bench.until(dut.host_sda, 1, 26_000)
    await host.stop()
    assert await host.read_word(WORD["version"]) == DEFAULT["version"]


@cocotb.test()
async def nack_stops_the_trigger(dut):
    bench = Bench(dut)
    table = short_table()
    for transfer, byte, triggers in ((0, 0, 0), (2, 1, 0), (5, 2, 0), (8, 0, 1)):
        await started(bench, table, fault=lambda lens: lens.nack_at.update({transfer: byte}))
        await failed_with(bench, "lens_nack", triggers)
        await starts_anew(bench, table)


@cocotb.test()
async def stretched_clock_within_the_limit_moves_no_trigger(dut):
    bench = Bench(dut)
    table = short_table()
    await started(bench, table, fault=lambda lens: lens.stretch_at.update({4: 15 * TICK_CYCLES * CLOCK_PS}))
    await bench.until_triggers(4, 6_000)
    await bench.wait_us(100)
    expected = expect(table, 1, TICK_CYCLES, BIT_CYCLES)
    expected.codes.clear()  # the code itself comes later, of course
    bench.check(table, expected)
    assert await bench.errors() == set()


@cocotb.test()
async def stretched_clock_beyond_the_limit_is_an_error(dut):
    bench = Bench(dut)
    table = short_table()
    await started(bench, table, fault=lambda lens: lens.stretch_at.update({4: 150 * TICK_CYCLES * CLOCK_PS}))
    await failed_with(bench, "lens_stretch", 0)
    await starts_anew(bench, table)


@cocotb.test()
async def stretched_clock_that_delays_a_code_gives_no_late_trigger(dut):
    bench = Bench(dut)
    table = short_table()
    # With the last the code comes in time, but not the lens: 15 us of the 30 that it takes to settle are missing
    for transfer, stretch_us, triggers in ((4, 60, 0), (8, 60, 1), (4, 35, 0)):
        stretch = {transfer: stretch_us * TICK_CYCLES * CLOCK_PS}
        await started(bench, table, fault=lambda lens: lens.stretch_at.update(stretch))
        await failed_with(bench, "late", triggers)
        assert await bench.host.read_word(WORD["error_plane"]) == 0
        await starts_anew(bench, table)


@cocotb.test()
async def sda_held_for_a_while_is_freed_by_clocks(dut):
    """A slave that was cut off in a read: after a start from standstill the sweep runs as if nothing had been."""
    bench = Bench(dut)
    table = short_table()
    await started(bench, table, fault=lambda lens: lens.hold(5))
    await bench.until_triggers(3, 6_000)
    await bench.wait_us(100)
    assert await bench.errors() == set()
    bench.check(table, expect(table, 1, TICK_CYCLES, BIT_CYCLES))


@cocotb.test()
async def sda_stuck_low_is_an_error(dut):
    bench = Bench(dut)
    table = short_table()
    await started(bench, table, fault=lambda lens: lens.hold(None))
    await failed_with(bench, "lens_stuck", 0)
    bench.lens.release()
    await starts_anew(bench, table)


@cocotb.test()
async def foreign_driver_on_the_lens_bus_is_an_error(dut):
    bench = Bench(dut)
    table = short_table()
    await started(bench, table)
    await RisingEdge(dut.trigger)
    await FallingEdge(dut.lens_sda)
    for _ in range(2):
        await FallingEdge(dut.lens_scl)
    dut.lens_sda_low.value = 1
    await bench.wait_us(8)
    dut.lens_sda_low.value = 0
    await failed_with(bench, "lens_arbitration", 1)
    await starts_anew(bench, table)


@cocotb.test()
async def scl_held_low_is_an_error(dut):
    bench = Bench(dut)
    table = short_table()

    def hold_clock(lens):
        lens.scl_low.value = 1

    await started(bench, table, fault=hold_clock)
    await failed_with(bench, "lens_stretch", 0)
    dut.lens_scl_low.value = 0
    await starts_anew(bench, table)


@cocotb.test()
async def table_rewritten_in_mid_sweep_takes_effect_between_sweeps(dut):
    bench = Bench(dut)
    first, second = short_table(3), short_table(4, period_us=700, exposure_us=300, trigger_width_us=70)
    second.planes = [Plane(800 + number, 5, 900 + number, 20) for number in range(4)]
    await started(bench, first)
    await bench.until_triggers(4, 6_000)
    await second.write(bench.host, commit=False)
    await bench.until_triggers(8, 6_000)
    commit_sweep = (len(bench.trigger_starts()) - 1) // 3
    await bench.host.write_word(WORD["commit"], 1)
    await bench.host.write_word(WORD["period_us"], 900)  # without a commit, before the exchange
    assert await bench.status("commit_pending")
    whole = commit_sweep + 1
    await bench.until_triggers(3 * whole + 8, 16_000)
    await bench.wait_us(150)
    assert not await bench.status("commit_pending")
    before, after = expect(first, whole, TICK_CYCLES, BIT_CYCLES), expect(second, 2, TICK_CYCLES, BIT_CYCLES)
    shift = whole * 3 * first.period_us * TICK_CYCLES
    for name in ("trigger", "sync"):
        getattr(before, name).extend(tuple(time + shift for time in pulse) for pulse in getattr(after, name))
    before.codes += [(time + shift, code) for time, code in after.codes]
    bench.check(first, before)
    assert await bench.errors() == set()


@cocotb.test()
async def triangle_that_comes_in_use_begins_where_its_own_table_ends(dut):
    bench = Bench(dut)
    sawtooth, triangle = short_table(2), short_table(5, triangle=True)
    triangle.planes = [Plane(800 + number, 10, 900 + number, 30) for number in range(5)]
    await started(bench, sawtooth)
    await bench.until_triggers(1, 6_000)
    await triangle.write(bench.host)
    await bench.until_triggers(len(bench.trigger_starts()) + 2 + 10, 16_000)
    codes = [code for _, code in bench.lens.codes if code >= 900]
    assert codes[:10] == [904, 903, 902, 901, 900, 900, 901, 902, 903, 904]
    assert await bench.errors() == set()


@cocotb.test()
async def second_commit_replaces_the_one_that_waits(dut):
    bench = Bench(dut)
    await started(bench, short_table(3, period_us=3_000))
    await bench.until_triggers(1, 6_000)
    skipped, wanted = short_table(2), short_table(2)
    skipped.planes[0].code_b, wanted.planes[0].code_b = 11, 22
    await skipped.write(bench.host)
    await wanted.write(bench.host)
    await bench.until_triggers(8, 16_000)
    codes = [code for _, code in bench.lens.codes]
    assert 22 in codes and 11 not in codes


@cocotb.test()
async def run_dropped_in_mid_exposure_finishes_that_exposure(dut):
    bench = Bench(dut)
    table = short_table()
    await started(bench, table, "gated")
    await bench.wait_us(1_000)
    assert not bench.triggers and not int(dut.busy.value)
    dut.run.value = 1
    await bench.until_triggers(2, 6_000)
    await bench.wait_us(20)
    dut.run.value = 0
    await bench.wait_us(table.exposure_us - 40)
    assert int(dut.busy.value), "the exposure is cut short"
    await stands_still(bench, 2)
    width = table.trigger_width_us * TICK_CYCLES * CLOCK_PS
    assert [end - start for start, end in pulses(bench.triggers, 1)] == [width] * 2
    assert await bench.errors() == set()
    assert await bench.count("sweep") == 1
    bench.triggers.clear()
    bench.syncs.clear()
    bench.lens.codes.clear()
    dut.run.value = 1
    await bench.until_triggers(3, 6_000)
    await bench.wait_us(100)
    bench.check(table, expect(table, 1, TICK_CYCLES, BIT_CYCLES))
    assert await bench.count("sweep") == 2


@cocotb.test()
async def run_dropped_in_the_gap_stops_at_once(dut):
    bench = Bench(dut)
    table = short_table()
    await started(bench, table, "gated")
    dut.run.value = 1
    for moment_us in (20, 100, 300, 345):
        await bench.until_triggers(1, 6_000)
        await bench.wait_us(table.exposure_us + moment_us)
        dut.run.value = 0
        await stands_still(bench, 1)
        bench.triggers.clear()
        dut.run.value = 1
    assert await bench.errors() == set()


@cocotb.test()
async def enable_cleared_in_mid_sweep_stops_it(dut):
    bench = Bench(dut)
    await started(bench, short_table())
    await bench.until_triggers(2, 6_000)
    await bench.control()
    await stands_still(bench, 2)
    assert await bench.errors() == set()


@cocotb.test()
async def planes_out_of_range_are_refused(dut):
    bench = Bench(dut)
    for planes in (0, 1, 65, 0xFFFF):
        table = short_table()
        await started(bench, table)
        await bench.until_triggers(1, 6_000)
        await bench.host.write_word(WORD["planes"], planes)
        await bench.wait_us(2_000)
        assert await bench.errors() == set(), "refused before commit"
        count = len(bench.trigger_starts())
        await bench.host.write_word(WORD["commit"], 1)
        await bench.until(dut.error, 1, 500)
        assert len(bench.trigger_starts()) <= count + 1
        await failed_with(bench, "table_planes", len(bench.trigger_starts()))
        await starts_anew(bench, table)


@cocotb.test()
async def times_that_cannot_be_met_are_refused(dut):
    bench = Bench(dut)
    def one_more(table, **changes):
        for name, value in changes.items():
            setattr(table, name, value)
        return table
    slow = short_table()
    slow.planes[2].settle_us = 51
    lead = short_table(opto_on_us=51)
    tables = [(slow, 2), (lead, 0), (one_more(short_table(), exposure_us=147, trigger_width_us=50), 0),
              (one_more(short_table(), trigger_width_us=0), 0), (one_more(short_table(), trigger_width_us=201), 0),
              (one_more(short_table(), period_us=200), 0), (one_more(short_table(), opto_off_us=50), 0)]
    for table, plane in tables:
        await started(bench, table)
        await failed_with(bench, "table_timing", 0)
        assert await bench.host.read_word(WORD["error_plane"]) == plane
        assert not await bench.status("table_valid")
    slow.planes[2].settle_us = 50
    await started(bench, slow)
    await bench.until_triggers(4, 6_000)
    assert await bench.errors() == set()


@cocotb.test()
async def code_out_of_range_is_refused(dut):
    bench = Bench(dut)
    for plane, column in ((0, "code_a"), (2, "code_b")):
        table = short_table()
        setattr(table.planes[plane], column, 1024)
        await started(bench, table)
        await failed_with(bench, "table_code", 0)
        assert await bench.host.read_word(WORD["error_plane"]) == plane


@cocotb.test()
async def new_polarity_waits_for_standstill(dut):
    bench = Bench(dut)
    await started(bench, short_table())
    await bench.until_triggers(1, 6_000)
    await short_table(active_low=True).write(bench.host)
    # Two sweeps, at whose ends the table would be exchanged
    await bench.until_triggers(len(bench.trigger_starts()) + 6, 8_000)
    assert await bench.status("commit_pending")
    assert all(end - start == 50 * TICK_CYCLES * CLOCK_PS for start, end in pulses(bench.triggers, 1))
    await bench.control()
    await bench.until(dut.busy, 0, 2_000)
    await bench.wait_us(100)
    assert int(dut.trigger.value) == 1
    assert not await bench.status("commit_pending")


@cocotb.test()
async def reset_in_mid_sweep_leaves_the_lines_at_rest(dut):
    bench = Bench(dut)
    await started(bench, short_table())
    await bench.until_triggers(2, 6_000)
    dut.reset_button.value = 1
    await bench.wait_us(10)
    assert (int(dut.trigger.value), int(dut.sync.value), int(dut.busy.value)) == (0, 0, 0)
    assert int(dut.lens_scl.value) == int(dut.lens_sda.value) == 1
    dut.reset_button.value = 0
    await bench.wait_us(1_000)
    assert len(bench.trigger_starts()) == 2
    assert not await bench.status("table_valid")


@cocotb.test()
async def enable_without_a_table_gives_no_sweep(dut):
    bench = Bench(dut)
    await bench.reset()
    await bench.control("enable")
    await bench.wait_us(2_000)
    assert not bench.triggers and not int(dut.busy.value)
    assert await bench.errors() == set()
    assert int(dut.error.value) == 0
    assert BIT["control.enable"] == await bench.host.read_word(WORD["control"])
