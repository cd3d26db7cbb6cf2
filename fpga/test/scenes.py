# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The timing diagrams of doc/: each scene simulates an entity and compares what it drew with the committed picture.

run.py --update-drawings writes them anew.
"""

import os
from pathlib import Path

import cocotb
from cocotb.triggers import Timer

import coverage
from drawing import Recorder
from entity import CLOCK_PS, begin, cycles, cycles_until, drive, pulse

DOC = Path(__file__).resolve().parent.parent / "doc"


def keep(name, picture):
    """Compares, or writes when asked to."""
    file = DOC / f"{name}.svg"
    if "BENCH_UPDATE" in os.environ:
        file.write_text(picture, encoding="utf-8")
    assert file.read_text(encoding="utf-8") == picture, f"{file.name} is stale: run fpga/test/run.sh --update-drawings"


@cocotb.test()
async def synchronizer(dut):
    await begin(dut, async_in=1)
    await cycles(dut, 20)
    record = Recorder(clk=dut.clk, async_in=dut.async_in, sync_out=dut.sync_out)
    for level, length in ((1, 3), (0, 4), (1, 6), (0, 14), (1, 14)):
        dut.async_in.value = level
        await cycles(dut, length)
    keep("synchronizer", record.draw("synchronizer: 125 MHz, pulses below 50 ns are dropped"))


@cocotb.test()
async def trigger_output(dut):
    from test_trigger_output import start
    await start(dut, width=10, opto_on=2, opto_off=5)
    record = Recorder(fire=dut.fire, pin=dut.pin, active=dut.active)
    await cycles(dut, 16)
    await pulse(dut, dut.fire)
    await cycles(dut, 130)
    behind = lambda time: 17 * CLOCK_PS + time * 1_000_000
    keep("trigger_output", record.draw(
        "trigger_output: width 10 us, opto_on 2 us, opto_off 5 us, so the pin is high for 7 us",
        notes=[(behind(2), "camera sees the rise"), (behind(12), "camera sees the fall")]))


@cocotb.test()
async def i2c_master(dut):
    from test_i2c_master import Rig
    rig = Rig(dut)
    await rig.begin()
    record = Recorder(start=dut.start, state=dut.state, scl=dut.scl_in, sda=dut.sda_in, sda_low=dut.sda_low,
                      busy=dut.busy, done=dut.done, nack=dut.nack)
    await cycles(dut, 16)
    await rig.write(0x08, 0x5A)
    rig.lens.nack_at = {1: 0}
    await cycles(dut, 40)
    await rig.write(0x09, 0x02)
    await cycles(dut, 40)
    names = [name.removesuffix("_state") for name in coverage.states_of("i2c_master")]
    keep("i2c_master", record.draw("i2c_master: a byte write (29 bits of 2.5 us), then one that is not acknowledged",
                                   states={"state": names}))


@cocotb.test()
async def i2c_slave(dut):
    from test_i2c_slave import Rig
    rig = Rig(dut)
    await rig.begin()
    record = Recorder(scl=dut.scl_in, sda=dut.sda_in, sda_low=dut.sda_low, word_number=dut.word_number,
                      write=dut.write, read=dut.read)
    await rig.host.write_word(13, 0x0006)
    await rig.host.read_word(13)
    keep("i2c_slave", record.draw("i2c_slave: SMBus write word 13, then read word 13", vectors=["word_number"]))


@cocotb.test()
async def register_file(dut):
    from test_register_file import IDLE, write
    from words import WORD
    await begin(dut, **IDLE)
    record = Recorder(word_number=dut.word_number, write=dut.write, write_data=dut.write_data, commit=dut.commit,
                      apply=dut.apply,
                      **{"checked.period": dut.checked_period, "sweep.period": dut.sweep_period})
    await cycles(dut, 3)
    await write(dut, "period_us", 7000)
    await cycles(dut, 3)
    await write(dut, "commit", 1)
    await cycles(dut, 8)
    await pulse(dut, dut.apply)
    await cycles(dut, 6)
    assert WORD["period_us"] == 15
    keep("register_file", record.draw("register_file: a staged word, committed, then applied between two sweeps",
                                      vectors=["word_number", "write_data", "checked.period", "sweep.period"]))


@cocotb.test()
async def plane_table(dut):
    from test_plane_table import start, write_rows
    await start(dut, planes=3)
    await write_rows(dut, [[1, 2, 3, 4]] * 3)
    record = Recorder(commit=dut.commit, state=dut.dut.state, address=dut.dut.address, pending=dut.pending,
                      boundary=dut.boundary, apply=dut.apply, bank=dut.dut.bank)
    await cycles(dut, 3)
    await pulse(dut, dut.commit)
    await cycles(dut, 34)
    await pulse(dut, dut.boundary)
    await cycles(dut, 6)
    names = [name.removesuffix("_state") for name in coverage.states_of("plane_table")]
    keep("plane_table", record.draw("plane_table: three planes are copied and checked, and wait for the end of the sweep",
                                    vectors=["address"], states={"state": names}))


@cocotb.test()
async def host_interface(dut):
    from test_host_interface import Rig, table_of
    rig = Rig(dut)
    await rig.begin()
    await rig.commit(table_of(1, 2))
    dut.idle.value = 0
    inner = dut.dut
    record = Recorder(scl_in=dut.scl_in, sda_in=dut.sda_in, word_number=inner.word_number, write=inner.write,
                      commit=inner.commit, pending=inner.pending,
                      **{"progress.boundary": dut.progress_boundary, "sweep.period": dut.sweep_period})
    await rig.write("period_us", 1200)
    await rig.write("commit", 1)
    await cycles(dut, 200)
    await pulse(dut, dut.progress_boundary)
    await cycles(dut, 100)
    keep("host_interface", record.draw("host_interface: a new period, committed, and in use from the end of the sweep",
                                       vectors=["word_number", "sweep.period"]))


@cocotb.test()
async def plane_order(dut):
    from test_plane_order import Rig
    rig = Rig(dut)
    await rig.begin(3)
    await rig.slot()
    record = Recorder(clk=dut.clk, fetch=dut.fetch, table_read=dut.table_read, table_plane=dut.table_plane,
                      table_column=dut.table_column, fetched=dut.fetched, advance=dut.advance, plane=dut.plane,
                      first=dut.first, last=dut.last)
    await cycles(dut, 2)
    for _ in range(3):
        await rig.slot()
        await cycles(dut, 4)
    keep("plane_order", record.draw("plane_order: planes 1 and 2 of three, then plane 0 of the next sweep",
                                    vectors=["table_plane", "table_column", "plane"]))


@cocotb.test()
async def slot_timer(dut):
    from test_slot_timer import held
    await held(dut, period=20, flyback=8, exposure=10, lead=3)
    record = Recorder(running=dut.running, flyback=dut.flyback, slot_time=dut.slot_time, fire_due=dut.fire_due,
                      expose_due=dut.expose_due, slot_end=dut.slot_end)
    await cycles(dut, 8)
    drive(dut, running=1)
    await cycles(dut, 80)
    drive(dut, flyback=0)
    await cycles(dut, (28 + 2 * 20) * 8 - 80)
    drive(dut, running=0)
    await cycles(dut, 16)
    keep("slot_timer", record.draw("slot_timer: period 20 us, flyback 8 us at first, exposure 10 us, lead 3 us",
                                   vectors=["flyback", "slot_time"]))


@cocotb.test()
async def sweep_sequencer(dut):
    from test_sweep_sequencer import started
    rig = await started(dut)
    await cycles_until(dut, dut.progress_fire, 1, 4000)
    await cycles_until(dut, dut.dut.running, 1, 10)
    record = Recorder(state=dut.dut.state, lens_start=dut.lens_start, lens_register=dut.lens_register,
                      lens_value=dut.lens_value,
                      **{f"progress.{name}": getattr(dut, f"progress_{name}")
                         for name in ("plane", "fire", "fire_sync", "boundary")})
    await cycles(dut, 3 * 80 * 8 + 40)
    assert len(rig.fires) >= 3
    names = [name.removesuffix("_state") for name in coverage.states_of("sweep_sequencer")]
    keep("sweep_sequencer", record.draw("sweep_sequencer: three planes, period 80 us, exposure 40 us, writes of 5 us",
                                        vectors=["progress.plane", "lens_register", "lens_value"], states={"state": names}))


@cocotb.test()
async def lens_sweep_top(dut):
    from bench import Bench
    from sweep_model import Plane, Table
    bench = Bench(dut)
    await bench.reset()
    await Table([Plane(100, 9, 200, 90), Plane(300, 9, 400, 90)], period_us=1400, exposure_us=1000,
                trigger_width_us=100).write(bench.host)
    await bench.control("enable")
    await bench.until_triggers(1, 3_000)
    await bench.wait_us(950)
    record = Recorder(lens_scl=dut.lens_scl, lens_sda=dut.lens_sda, trigger=dut.trigger, sync=dut.sync, busy=dut.busy)
    codes = len(bench.lens.codes)
    await bench.wait_us(700)
    await Timer(1, unit="ps")
    notes = [(time - record.begin, f"code {code}") for time, code in bench.lens.codes[codes:]]
    keep("lens_sweep_top", record.draw(
        "lens_sweep_top: the 0.4 ms between two exposures (8 MHz): commit A; delay, stage and commit B; settle; trigger; "
        "stage the next code A", notes=notes))
