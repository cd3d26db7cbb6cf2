# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What stands between the tools of build.sh: the reader of FASM, the checks that end a build, the replay. Needs none of
the tools."""

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "flow"))
import build  # noqa: E402
import ice  # noqa: E402
import simulate  # noqa: E402
import tools  # noqa: E402
import xray  # noqa: E402


@pytest.fixture
def part(tmp_path):
    """A part of one logic tile, one pad tile and half a pad tile."""
    family = tmp_path / xray.FAMILY
    (family / "chip").mkdir(parents=True)
    (family / "chipclg1-1").mkdir()
    logic = {"type": "CLB", "bits": {"CLB_IO_CLK": {"baseaddr": "0x00000100", "offset": 2}}}
    pad = {"type": "IOB", "bits": {"CLB_IO_CLK": {"baseaddr": "0x00000200", "offset": 4}}}
    half = {"type": "IOB", "bits": {"CLB_IO_CLK": {"baseaddr": "0x00000200", "offset": 0, "alias": {}}}}
    (family / "chip" / "tilegrid.json").write_text(json.dumps({"CLB_X0Y0": logic, "IOB_X0Y0": pad, "HALF_X0Y1": half}))
    (family / "segbits_clb.db").write_text("CLB.LUT.INIT[00] 01_00\nCLB.LUT.INIT[10] 01_33\nCLB.FF.ON 02_07 !02_08\n"
                                           "CLB.FF.OFF 02_08\n")
    (family / "ppips_clb.db").write_text("CLB.A.B always\n")
    (family / "segbits_iob.db").write_text("IOB.IOB_Y1.PULLTYPE.NONE 00_01 !00_02\nIOB.IOB_Y1.PULLTYPE.PULLUP 00_01 00_02\n"
                                           "IOB.IOB_Y1.PULLTYPE.PULLDOWN !00_01 !00_02\n")
    (family / "chipclg1-1" / "package_pins.csv").write_text("pin,bank,site,tile\nA1,1,IOB_X0Y3,IOB_X0Y0\n")
    return xray.Part(tmp_path, "chipclg1-1")


def test_features_become_bits(part):
    bits = part.assemble("# words\nCLB_X0Y0.LUT.INIT[15:0] = 16'b0000010000000001\nCLB_X0Y0.FF.ON\nCLB_X0Y0.A.B\n\n"
                         "CLB_X0Y0.LUT.INIT[10]\nCLB_X0Y0.FF.OFF = 0\n")
    assert bits == {(0x101, 2, 0), (0x101, 3, 1), (0x102, 2, 7)}


@pytest.mark.parametrize("fasm", ["CLB_X0Y0.FF.ON\nCLB_X0Y0.FF.OFF", "CLB_X0Y0.FF.HALF", "CLB_X9Y9.FF.ON",
                                  "HALF_X0Y1.IOB_Y1.PULLTYPE.NONE", "CLB_X0Y0.FF.ON and more"])
def test_what_cannot_be_a_bitstream_is_an_error(part, fasm):
    with pytest.raises(ValueError):
        part.assemble(fasm)


def test_frames_hold_the_bits():
    words = xray.frames_text({(0x101, 3, 1), (0x101, 0, 31), (0x7, 100, 0)}).splitlines()
    assert [line.split()[0] for line in words] == ["0x00000007", "0x00000101"]
    assert words[1].split()[1].split(",")[:4] == ["0x80000000", "0x00000000", "0x00000000", "0x00000002"]


def test_error_correction_is_no_bit_of_the_design():
    assert xray.read_back("bit_00000101_003_01\nbit_00000101_050_12\nbit_00000101_050_13\n") == {(0x101, 3, 1),
                                                                                                (0x101, 50, 13)}


@pytest.mark.parametrize("bits, pull", [(set(), "PULLDOWN"), ({1}, "NONE"), ({1, 2}, "PULLUP"), ({2}, "unclear []")])
def test_pull_is_read_from_the_bits(part, bits, pull):
    assert part.pull_of("A1", {(0x200, 4, bit) for bit in bits}) == pull


CONFIGURATION = """.comment made by hand
.device 5k
.io_tile 3 0
000000
000100
000000

.io_tile 4 0
000000
000000

.logic_tile 1 1
010
.sym 2 name
"""


def test_tiles_without_a_bit_are_left_out_of_a_configuration():
    assert ice.tiles_of(CONFIGURATION) == {("io_tile", 3, 0): ["000000", "000100", "000000"],
                                           ("logic_tile", 1, 1): ["010"]}


def test_pull_of_an_ice40_pin_is_a_bit_of_another_tile_that_switches_it_off(tmp_path):
    (tmp_path / "icebox.py").write_text('pinloc_db = {"5k-sg48": [("2", 8, 0, 0), ("3", 9, 0, 1)]}\n'
                                        'ieren_db = {"5k": [(8, 0, 0, 3, 0, 1), (9, 0, 1, 4, 0, 0)]}\n')
    pads = ice.Pads(tmp_path, "5k", "sg48")
    tiles = ice.tiles_of(CONFIGURATION)
    assert (pads.pull_of("2", tiles), pads.pull_of("3", tiles)) == ("NONE", "PULLUP")
    with pytest.raises(KeyError):
        pads.pull_of("35", tiles)


class Packer:
    """ecppack and ecpunpack, of which the second gives this text back."""

    def __init__(self, folder, read_back):
        self.work, self.read_back = folder, read_back
        (folder / "board").mkdir()
        (folder / "board" / "routed.config").write_text(".device A\n\n.sysconfig COMPRESS_CONFIG ON\n.tile B\nenum: C ON\n")

    def run(self, command, *arguments):
        source, target = (self.work / "board" / Path(arguments[index]).name for index in (1, 3))
        lines = self.read_back if command == "ecpunpack" else "".join(sorted(source.read_text().split("\n")))
        target.write_text(lines)


@pytest.mark.parametrize("read_back, whole", [(".device A\n.tile B\nenum: C ON\n", True), (".device A\n.tile B\n", False)])
def test_bit_that_is_not_read_back_from_an_ecp5_ends_the_build(tmp_path, monkeypatch, read_back, whole):
    monkeypatch.setattr(tools, "root_of", lambda suite: tools.Root(suite))
    family = build.Ecp5({"part": "LFE5U-25F"})
    family.root = Packer(tmp_path, read_back)
    if whole:
        family.pack("board")
    else:
        with pytest.raises(tools.Failed, match="read back"):
            family.pack("board")


def test_linux_gets_words_with_the_low_byte_first():
    header, sync = b"\x00\x09head" + b"\xff" * 8, bytes.fromhex("000000bb11220044aa995566")
    assert build.swapped(header + sync) == b"\xff" * 8 + bytes.fromhex("bb00000044002211665599aa")


class Router:
    """Reaches these clocks, one with each seed; None for a path that is too fast."""

    def __init__(self, folder, reached):
        self.root, self.reached, self.folder = tools.Root("none"), reached, folder
        self.root.work = folder
        (folder / "board").mkdir()

    def route(self, name, seed):
        if self.reached[seed - 1] is None:
            raise tools.Failed("ERROR: Hold/min time violation\nInfo: Max frequency for clock 'clk': 200 MHz")
        report = {"fmax": {"a": {"achieved": 500}, "clk": {"achieved": self.reached[seed - 1]}}}
        (self.folder / name / "report.json").write_text(json.dumps(report))
        return ""


def test_first_placement_with_margin_is_taken(tmp_path):
    assert build.close_timing(Router(tmp_path, [99, None, 104, 105.5, 200]), "board", 100e6) == 105.5e6


def test_timing_that_does_not_close_ends_the_build(tmp_path):
    with pytest.raises(tools.Failed, match="does not close"):
        build.close_timing(Router(tmp_path, [104.9, None] * 4), "board", 100e6)


def test_failure_of_the_router_is_no_matter_of_placement(tmp_path):
    router = Router(tmp_path, [])
    router.route = lambda name, seed: (_ for _ in ()).throw(tools.Failed("no such pin"))
    with pytest.raises(tools.Failed, match="no such pin"):
        build.close_timing(router, "board", 100e6)


def test_generic_that_is_not_there_is_an_error():
    text = "    CLOCK_HZ : positive := 125_000_000;\n    GLITCH_S        : real     := 50.0e-9;\n"
    assert build.with_defaults(text, {"GLITCH_S": "1.0e-9"}).endswith("real     := 1.0e-9;\n")
    with pytest.raises(ValueError, match="TICK_HZ"):
        build.with_defaults(text, {"TICK_HZ": 1})


def buffer_of(**pins):
    return {"cells": {"pad": simulate.gate("$_TBUF_", **pins)},
            "ports": {"sda": {"direction": "inout", "bits": [2]}}}


def test_pad_that_drives_high_is_refused():
    module = buffer_of(A="0", E=3, Y=2)
    simulate.open_pads(module)
    assert module["ports"] == {"sda": {"direction": "input", "bits": [2]},
                               "sda_pulled": {"direction": "output", "bits": [3]}}
    with pytest.raises(tools.Failed, match="driven high"):
        simulate.open_pads(buffer_of(A="1", E=3, Y=2))


def test_block_ram_in_a_mode_without_a_model_is_refused():
    parameters = {name: format(value, "032b") if isinstance(value, int) else value
                  for name, value in simulate.RAM_MODES["RAMB18E1"].items()}
    cell = {"type": "RAMB18E1", "parameters": parameters, "connections": {"RSTRAMB": ["0"], "WEBWE": ["0"] * 4}}
    simulate.check_ram("ram", cell)
    for change in ({"WRITE_MODE_A": "WRITE_FIRST"}, {"READ_WIDTH_B": format(9, "032b")}, {"INIT_0A": "0001"}):
        with pytest.raises(tools.Failed):
            simulate.check_ram("ram", cell | {"parameters": parameters | change})


def ice40_ram(**changes):
    parameters = {"READ_MODE": "00", "WRITE_MODE": "00", "INIT_0": "0" * 256}
    pins = {"RE": ["1"], "WE": ["1"], "RCLK": [2], "WCLK": [2], "RCLKE": [3], "WCLKE": [4], "MASK": [5] * 16,
            "RADDR": [*range(10, 21)], "WADDR": [*range(30, 41)], "RDATA": [*range(50, 66)], "WDATA": [*range(70, 86)]}
    cell = {"type": "SB_RAM40_4K", "parameters": {name: changes.get(name, value) for name, value in parameters.items()},
            "connections": {name: changes.get(name, value) for name, value in pins.items()}}
    return {"cells": {"ram": cell}}


def test_block_ram_of_an_ice40_writes_where_it_is_not_masked():
    module = ice40_ram()
    simulate.model_rams(module)
    ram, write = module["cells"]["ram"]["connections"], module["cells"]["ram_write"]
    assert write["type"] == "$_ANDNOT_" and write["connections"] == {"A": [4], "B": [5], "Y": ram["write"]}
    assert (ram["read"], ram["read_data"][:16], ram["write_address"]) == ([3], [*range(50, 66)], [*range(30, 40)])
    assert len({*ram["read_data"], *ram["write"]}) == 19, "a net has two drivers"


@pytest.mark.parametrize("changes", [{"MASK": [5] * 15 + [6]}, {"READ_MODE": "10", "WRITE_MODE": "10"},
                                     {"READ_MODE": "01"}, {"INIT_0": "1" * 256}, {"WE": [7]}])
def test_block_ram_of_an_ice40_without_a_model_is_refused(changes):
    with pytest.raises(tools.Failed):
        simulate.model_rams(ice40_ram(**changes))


def gates(tmp_path, extra=()):
    """trigger follows run a clock later, error is its inverse at once."""
    module = {"ports": {name: {"direction": direction, "bits": [bit]} for name, direction, bit in
                        (("clk", "input", 2), ("run", "input", 3), ("trigger", "output", 4), ("error", "output", 5))},
              "netnames": {"trigger": {"bits": [4], "attributes": {}}},
              "cells": {"ff": simulate.made("$_DFF_P_", {"C": [2], "D": [3], "Q": [4]}, ("Q",)),
                        "not": simulate.gate("$_NOT_", A=4, Y=5), **dict(extra)}}
    file = tmp_path / "gates.txt"
    file.write_text("\n".join(simulate.lines_of(module)) + "\n")
    return file


@pytest.mark.parametrize("extra", [simulate.gate("$_DLATCH_P_", E=3, D=3, Y=6),
                                   simulate.made("$_DFF_P_", {"C": [3], "D": [3], "Q": [6]}, ("Q",))])
def test_cell_that_the_replay_does_not_know_is_refused(tmp_path, extra):
    with pytest.raises(tools.Failed, match="not known"):
        gates(tmp_path, [("cell", extra)])


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """Where the replay is compiled to, once."""
    return tmp_path_factory.mktemp("compiled")


@pytest.mark.parametrize("changes, agrees", [
    ([(0, "0U"), (20, "10"), (21, "11"), (30, "01"), (31, "00")], True),
    ([(0, "00"), (20, "11"), (30, "01"), (31, "00")], False),
    ([(0, "00"), (20, "10"), (22, "11"), (30, "00")], False),
    ([], False)])
def test_replay_sees_a_clock_that_differs(tmp_path, compiled, monkeypatch, changes, agrees):
    monkeypatch.setattr(tools, "ROOTS", compiled)
    trace = tmp_path / "trace"
    trace.write_text("".join(f"{edge} 0{run}HHHH0{trigger}0{'0' if trigger == '1' else '1'}\n"
                             for edge, (run, trigger) in changes))
    assert simulate.replay(gates(tmp_path), trace)[0] == agrees
