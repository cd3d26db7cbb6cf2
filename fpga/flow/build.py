# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Makes the bitstream of a board with open tools: GHDL, Yosys, nextpnr, and prjxray's, prjtrellis' or IceStorm's database.

    build.sh BOARD...       the boards of boards.toml; the bitstream and its reports come to build/fpga/BOARD/

Ends with an error if a clock is not reached with margin, or if what is read back from the bitstream is not what the
constraints ask of the pins.
"""

import array
import json
import re
import shutil
import sys
import tomllib
from collections import Counter
from pathlib import Path

import ice
import tools
import xray
from pins import PULLS, pins_of

FPGA = Path(__file__).resolve().parent.parent
OUTPUT = FPGA.parent / "build" / "fpga"
BOARDS = tomllib.loads((FPGA / "boards.toml").read_text(encoding="utf-8"))
TOP = "lens_sweep_top"
# The clock that is reached must be above the one of the board by this
MARGIN = 1.05
# Placements that are tried; the router does not mend a path that is too fast
SEEDS = range(1, 9)
SYNTHESIS = {"xc7": "synth_xilinx -family xc7 -top {top} -flatten -abc9", "ecp5": "synth_ecp5 -top {top} -abc9",
             "ice40": "synth_ice40 -top {top} -device u -abc9"}
ECP5_SIZE = {"LFE5U-12F": "--12k", "LFE5U-25F": "--25k", "LFE5U-85F": "--85k"}
# The words with which a 7-series part finds the width of the bus that loads it
BUS_WIDTH = bytes.fromhex("000000bb11220044")
# The mapper's cells, by what they are
KINDS = {"look-up tables": r"LUT[1-6]|SB_LUT4", "flip-flops": r"FD[RSCP]E|TRELLIS_FF|SB_DFF\w*",
         "carry cells": r"CARRY4|CCU2C|SB_CARRY", "block RAMs": r"RAMB18E1|RAMB36E1|DP16KD|SB_RAM40_4K"}


def verilog(root, name, rtl, generics):
    """GHDL's netlist of the design, as Verilog in the folder `name` of the root; gives the file."""
    here, there = root.fresh(name)
    shutil.copytree(rtl, here / "rtl")
    lines = (FPGA / "sources.txt").read_text(encoding="utf-8").splitlines()
    files = [f"{there}/rtl/{Path(line.split()[1]).name}" for line in lines if line and not line.startswith("#")]
    top = here / "rtl" / f"{TOP}.vhd"
    top.write_text(with_defaults(top.read_text(encoding="utf-8"), generics), encoding="utf-8")
    said = root.run("ghdl-mcode", "--synth", "--std=08", f"--workdir={there}", "-Wno-unhandled-attribute", "--out=verilog",
                    *files, "-e", TOP,
                    output=f"{name}/{TOP}.v")
    if "warning" in said:
        raise tools.Failed(f"GHDL warns:\n{said}")
    # Its comments name the files, and these lie elsewhere in another checkout
    made = here / f"{TOP}.v"
    made.write_text(re.sub(r"/\*.*?\*/", "", made.read_text(encoding="utf-8"), flags=re.DOTALL), encoding="utf-8")
    return made


def with_defaults(text, generics):
    """The entity with other defaults of its generics; GHDL's synthesis takes no real numbers from outside."""
    for generic, value in generics.items():
        text, count = re.subn(rf"^(    {generic} *: \w+ *:= )[^;\n]+", rf"\g<1>{value}", text, flags=re.MULTILINE)
        if count != 1:
            raise ValueError(f"{TOP} has no generic {generic}")
    return text


def synthesise(root, name, family):
    """Maps the Verilog of the folder to the family's cells: `netlist.json`."""
    script = f"read_verilog {tools.WORK}/{name}/{TOP}.v; {SYNTHESIS[family].format(top=TOP)}; check -assert; " \
             f"write_json {tools.WORK}/{name}/netlist.json"
    root.run("yosys", "-q", "-l", f"{tools.WORK}/{name}/yosys.log", "-p", script)


def cells_of(folder):
    """How many of each cell the mapped netlist has."""
    modules = json.loads((folder / "netlist.json").read_text(encoding="utf-8"))["modules"]
    return Counter(cell["type"] for cell in modules[TOP]["cells"].values())


def resources(folder):
    cells = cells_of(folder)
    return {kind: sum(number for cell, number in cells.items() if re.fullmatch(names, cell))
            for kind, names in KINDS.items()}


class Ecp5:
    """nextpnr-ecp5 and prjtrellis."""

    def __init__(self, board):
        self.board = board
        self.root = tools.root_of("trixie")
        self.database = self.root.folder / "usr/share/trellis/database/ECP5" / board["part"].replace("12F", "25F")

    def route(self, name, seed):
        work = f"{tools.WORK}/{name}"
        return self.root.run("nextpnr-ecp5", ECP5_SIZE[self.board["part"]], "--package", "CABGA381", "--speed", "6",
                             "--json", f"{work}/netlist.json", "--lpf", f"{work}/{self.board['constraints']}",
                             "--textcfg", f"{work}/routed.config", "--report", f"{work}/report.json", "--seed", str(seed))

    def pack(self, name):
        here, work = self.root.work / name, f"{tools.WORK}/{name}"
        self.root.run("ecppack", "--input", f"{work}/routed.config", "--bit", f"{work}/{TOP}.bit")
        # What is read back has other names for the same bits, and lacks the settings of the whole: packed again with
        # these it must be the same bitstream
        device, rest = self.read_back(name).split("\n", 1)
        settings = re.findall(r"^\.sysconfig .*$", (here / "routed.config").read_text(encoding="utf-8"), re.MULTILINE)
        (here / "again.config").write_text("\n".join([device, *settings, rest]), encoding="utf-8")
        self.root.run("ecppack", "--input", f"{work}/again.config", "--bit", f"{work}/again.bit")
        if (here / "again.bit").read_bytes() != (here / f"{TOP}.bit").read_bytes():
            raise tools.Failed("the bitstream has other bits than are read back from it")

    def read_back(self, name):
        work = f"{tools.WORK}/{name}"
        self.root.run("ecpunpack", "--input", f"{work}/{TOP}.bit", "--textcfg", f"{work}/read_back.config")
        return (self.root.work / name / "read_back.config").read_text(encoding="utf-8")

    def pulls(self, name, pins):
        """Pull of each pin in the bitstream. What is unpacked does not name a pull whose bits are all 0: DOWN."""
        text = self.read_back(name)
        places = json.loads((self.database / "iodb.json").read_text(encoding="utf-8"))["packages"]["CABGA381"]
        found = {}
        for port, (pin, _) in pins.items():
            row, column, pio = (places[pin][key] for key in ("row", "col", "pio"))
            # At the sides the pull is a row further, at the top and bottom the second pin of a pair has its own tile
            row, column = (row + 1, column) if column == 0 or pio in "CD" else (row, column + (pio == "B"))
            tile = re.search(rf"^\.tile MIB_R{row}C{column}:\w*PI[CO]\w+\n((?:[^.\n].*\n)*)", text, re.MULTILINE)
            settings = dict(re.findall(rf"^enum: PIO{pio}\.(\w+) (\w+)$", tile.group(1), re.MULTILINE))
            found[port] = PULLS[settings.get("PULLMODE", "DOWN")] if "BASE_TYPE" in settings else "unused"
        return found


class Ice40:
    """nextpnr-ice40 and IceStorm."""

    def __init__(self, board):
        self.board = board
        self.root = tools.root_of("trixie")

    def route(self, name, seed):
        work = f"{tools.WORK}/{name}"
        return self.root.run("nextpnr-ice40", f"--{self.board['part']}", "--package", "sg48", "--json",
                             f"{work}/netlist.json", "--pcf", f"{work}/{self.board['constraints']}", "--asc",
                             f"{work}/routed.asc", "--report", f"{work}/report.json", "--freq",
                             str(self.board["clock_hz"] / 1e6), "--seed", str(seed))

    def pack(self, name):
        self.root.run("icepack", f"{tools.WORK}/{name}/routed.asc", f"{tools.WORK}/{name}/{TOP}.bit")
        if self.read_back(name) != ice.tiles_of((self.root.work / name / "routed.asc").read_text(encoding="utf-8")):
            raise tools.Failed("the bitstream has other bits than were routed")

    def read_back(self, name):
        self.root.run("iceunpack", f"{tools.WORK}/{name}/{TOP}.bit", f"{tools.WORK}/{name}/read_back.asc")
        return ice.tiles_of((self.root.work / name / "read_back.asc").read_text(encoding="utf-8"))

    def pulls(self, name, pins):
        pads, tiles = ice.pads_of(self.root, self.board["part"].removeprefix("up"), "sg48"), self.read_back(name)
        return {port: pads.pull_of(pin, tiles) for port, (pin, _) in pins.items()}


class Xc7:
    """nextpnr-himbaechel-xilinx and prjxray."""

    def __init__(self, board):
        self.board = board
        self.root = tools.root_of("forky")
        self.database = self.root.folder / "usr/share/prjxray/database"

    def route(self, name, seed):
        work = f"{tools.WORK}/{name}"
        return self.root.run("nextpnr-himbaechel-xilinx", "--device", self.board["part"], "--json",
                             f"{work}/netlist.json", "-o", f"xdc={work}/{self.board['constraints']}", "-o",
                             f"fasm={work}/routed.fasm", "--report", f"{work}/report.json", "--seed", str(seed))

    def pack(self, name):
        here, part = self.root.work / name, self.board["part"]
        database = xray.Part(self.database, part)
        bits = database.assemble((here / "routed.fasm").read_text(encoding="utf-8") + "\n" + database.required())
        (here / "frames.txt").write_text(xray.frames_text(bits), encoding="utf-8")
        self.root.run("xc7frames2bit", "--part_name", part, "--part_file", self.part_file(), "--frm_file",
                      f"{tools.WORK}/{name}/frames.txt", "--output_file", f"{tools.WORK}/{name}/{TOP}.bit")
        if self.read_back(name) != bits:
            raise tools.Failed("the bitstream has other bits than were assembled")
        (here / f"{TOP}.bin").write_bytes(swapped((here / f"{TOP}.bit").read_bytes()))

    def part_file(self):
        return f"/usr/share/prjxray/database/{xray.FAMILY}/{self.board['part']}/part.yaml"

    def read_back(self, name):
        self.root.run("bitread", "-part_file", self.part_file(), "-y", "-o", f"{tools.WORK}/{name}/bits.txt",
                      f"{tools.WORK}/{name}/{TOP}.bit")
        return xray.read_back((self.root.work / name / "bits.txt").read_text(encoding="utf-8"))

    def pulls(self, name, pins):
        database, bits = xray.Part(self.database, self.board["part"]), self.read_back(name)
        return {port: database.pull_of(pin, bits) for port, (pin, _) in pins.items()}


def swapped(bitstream):
    """What Linux' driver of the Zynq loads: the words from the bus-width detection on, with the low byte first."""
    start = bitstream.index(BUS_WIDTH)
    start -= next(count for count in range(0, start, 4) if bitstream[start - count - 4:start - count] != b"\xff" * 4)
    words = array.array("I", bitstream[start:start + (len(bitstream) - start) // 4 * 4])
    words.byteswap()
    return words.tobytes()


FAMILIES = {"ecp5": Ecp5, "ice40": Ice40, "xc7": Xc7}


def close_timing(family, name, clock_hz):
    """Routes with one seed after the other until every clock is reached with margin and nothing comes too early; gives
    the clock that was reached."""
    folder = family.root.work / name
    for seed in SEEDS:
        try:
            (folder / "nextpnr.log").write_text(family.route(name, seed), encoding="utf-8")
            reached = slowest_clock(folder)
            reason = f"{reached / 1e6:.1f} MHz are reached"
            if reached >= clock_hz * MARGIN:
                return reached
        except tools.Failed as failure:
            if "Max frequency for clock" not in str(failure):
                raise
            reason = "a path is too slow or too fast"
        print(f"fpga: {name}: seed {seed}: {reason}", flush=True)
    raise tools.Failed(f"{name}: the timing does not close at {clock_hz * MARGIN / 1e6:.1f} MHz")


def slowest_clock(folder):
    """The lowest of the clocks that the router reached, in hertz."""
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return min(clock["achieved"] for clock in report["fmax"].values()) * 1e6


def build(name):
    """The bitstream of one board; gives (resources, clock reached)."""
    board = BOARDS[name]
    synthesis = tools.root_of("trixie")
    verilog(synthesis, name, FPGA / "rtl", {"CLOCK_HZ": board["clock_hz"]})
    synthesise(synthesis, name, board["family"])
    family = FAMILIES[board["family"]](board)
    folder = family.root.work / name
    if family.root.folder != synthesis.folder:
        shutil.copytree(synthesis.work / name, family.root.fresh(name)[0], dirs_exist_ok=True)
    shutil.copy(FPGA / "constraints" / board["constraints"], folder)
    reached = close_timing(family, name, board["clock_hz"])
    family.pack(name)
    pins = pins_of(board["constraints"])
    for port, pull in family.pulls(name, pins).items():
        if pull != pins[port][1]:
            raise tools.Failed(f"{name}: {port} has {pull} in the bitstream, {pins[port][1]} in the constraints")
    target = OUTPUT / name
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    for file in (f"{TOP}.bit", f"{TOP}.bin", "nextpnr.log", "report.json", "yosys.log", "netlist.json"):
        if (folder / file).exists():
            shutil.copy(folder / file, target)
    return resources(target), reached


def row(name, used, reached):
    """A line of the README's table."""
    clock = BOARDS[name]["clock_hz"]
    return f"| `{name}` | {BOARDS[name]['part']} | {clock / 1e6:.0f} MHz | {reached / 1e6:.0f} MHz | " + \
           " | ".join(str(number) for number in used.values()) + " |"


def main():
    names = sys.argv[1:]
    if not names or set(names) - set(BOARDS):
        sys.exit(f"{__doc__}\nBoards: {' '.join(BOARDS)}")
    try:
        for name in names:
            used, reached = build(name)
            print(row(name, used, reached))
            print(f"fpga: {OUTPUT / name / TOP}.bit is whole; load it with: {BOARDS[name]['loads']} {TOP}.bit")
    except tools.Unavailable as reason:
        sys.exit(f"fpga: the tools cannot be had here: {reason}")
    except tools.Failed as reason:
        sys.exit(f"fpga: {reason}")


if __name__ == "__main__":
    main()
