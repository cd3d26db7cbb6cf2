# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A mapped netlist, taken apart into gates on which replay.cpp replays a trace of the pins and compares every clock.

Yosys takes the netlist apart by the family's own models of its cells. What these do not have is put in: the block RAM,
in the one way that the design uses it, and the open-drain pads, which become an input and an output `NAME_pulled`.
"""

import graphlib
import hashlib
import itertools
import json
import re
import shutil
import subprocess
from pathlib import Path

import build
import tools

TOP = "lens_sweep_top"
CELLS = {"ecp5": "/usr/share/yosys/ecp5/cells_sim.v", "ice40": "/usr/share/yosys/ice40/cells_sim.v",
         "xc7": "/usr/share/yosys/xilinx/cells_sim.v"}
# How the block RAMs must be used for block_ram.v to be right
RAM_MODES = {
    "DP16KD": {"DATA_WIDTH_A": 18, "DATA_WIDTH_B": 18, "REGMODE_A": "NOREG", "REGMODE_B": "NOREG",
               "WRITEMODE_A": "READBEFOREWRITE", "CSDECODE_A": "0b000", "CSDECODE_B": "0b000", "CLKAMUX": "CLKA",
               "CLKBMUX": "CLKB"},
    "SB_RAM40_4K": {},
    "RAMB18E1": {"RAM_MODE": "TDP", "READ_WIDTH_A": 0, "READ_WIDTH_B": 18, "WRITE_WIDTH_A": 18, "WRITE_WIDTH_B": 0,
                 "DOA_REG": 0, "DOB_REG": 0, "WRITE_MODE_A": "READ_FIRST", "WRITE_MODE_B": "READ_FIRST"},
}
# Pins that must rest at this level
RAM_PINS = {
    "DP16KD": {"CEA": "1", "WEB": "0", "RSTB": "0", **{f"CS{port}{bit}": "0" for port in "AB" for bit in range(3)}},
    "SB_RAM40_4K": {"RE": "1", "WE": "1"},
    "RAMB18E1": {"RSTRAMB": "0", "WEBWE": "0"},
}


def number(parameter):
    """A parameter of Yosys' JSON: bits are a number, anything else stays text."""
    return int(parameter, 2) if re.fullmatch("[01]{4,}", parameter) else parameter


def check_ram(name, cell):
    """The block RAM is used as block_ram.v has it, and begins with zeros."""
    kind, parameters, pins = cell["type"], cell["parameters"], cell["connections"]
    for parameter, value in RAM_MODES[kind].items():
        if number(parameters[parameter]) != value:
            raise tools.Failed(f"{name}: {parameter} is {parameters[parameter]}, its model knows {value}")
    for pin, level in RAM_PINS[kind].items():
        if set(pins[pin]) != {level}:
            raise tools.Failed(f"{name}: {pin} is not {level}, as its model has it")
    for parameter, value in parameters.items():
        if re.fullmatch("INIT(P|VAL)?_[0-9A-F]{1,2}", parameter) and "1" in value:
            raise tools.Failed(f"{name}: begins with {parameter} = {value}, its model with zeros")


def model_rams(module):
    """Each block RAM becomes a block_ram."""
    fresh = fresh_nets(module)
    for name, cell in list(module["cells"].items()):
        pins = cell["connections"]
        if cell["type"] not in RAM_MODES:
            continue
        check_ram(name, cell)

        def bus(prefix, first, last):
            return [pins[f"{prefix}{bit}"][0] for bit in range(first, last + 1)]

        def lanes(data, parity):
            return pins[data][:8] + pins[parity][:1] + pins[data][8:] + pins[parity][1:]

        if cell["type"] == "DP16KD":
            connections = {"write_clock": pins["CLKA"], "write": pins["WEA"], "lanes": bus("ADA", 0, 1),
                           "write_address": bus("ADA", 4, 13), "write_data": bus("DIA", 0, 17),
                           "read_clock": pins["CLKB"], "read": pins["CEB"], "read_address": bus("ADB", 4, 13),
                           "read_data": bus("DOB", 0, 17)}
        elif cell["type"] == "SB_RAM40_4K":
            # 256 words of 16 bits, or 512 of 8, which lie at the even bits of the data; a word is masked as a whole
            modes = cell["parameters"]["READ_MODE"], cell["parameters"]["WRITE_MODE"]
            if modes not in (("00", "00"), ("01", "01")) or len(set(pins["MASK"])) != 1:
                raise tools.Failed(f"{name}: the modes {modes} or a mask of single bits have no model")
            write = next(fresh)
            module["cells"][f"{name}_write"] = gate("$_ANDNOT_", A=pins["WCLKE"][0], B=pins["MASK"][0], Y=write)
            connections = {"write_clock": pins["WCLK"], "write": [write], "lanes": ["1", "1"],
                           "write_address": pins["WADDR"][:10], "write_data": pins["WDATA"] + ["0", "0"],
                           "read_clock": pins["RCLK"], "read": pins["RCLKE"], "read_address": pins["RADDR"][:10],
                           "read_data": pins["RDATA"] + [next(fresh), next(fresh)]}
        else:
            connections = {"write_clock": pins["CLKARDCLK"], "write": pins["ENARDEN"], "lanes": pins["WEA"],
                           "write_address": pins["ADDRARDADDR"][4:], "write_data": lanes("DIADI", "DIPADIP"),
                           "read_clock": pins["CLKBWRCLK"], "read": pins["ENBWREN"],
                           "read_address": pins["ADDRBWRADDR"][4:], "read_data": lanes("DOBDO", "DOPBDOP")}
        module["cells"][name] = made("block_ram", connections, ("read_data",))


def fresh_nets(module):
    """Numbers of nets that the module has not."""
    return itertools.count(1 + max(bit for cell in module["cells"].values() for bits in cell["connections"].values()
                                   for bit in bits if isinstance(bit, int)))


def open_pads(module):
    """Each open-drain pad becomes an input, and an output NAME_pulled that says that the design pulls it."""
    cells, ports = module["cells"], module["ports"]
    fresh = fresh_nets(module)
    pads = {port["bits"][0]: name for name, port in ports.items() if port["direction"] == "inout"}
    for name, cell in list(cells.items()):
        pins = {pin: bits[0] for pin, bits in cell["connections"].items()}
        if cell["type"] == "$_TBUF_":
            pad, data, low = pads.pop(pins["Y"]), pins["A"], pins["E"]
        elif cell["type"] == "IOBUF":
            pad, data, low = pads.pop(pins["IO"]), pins["I"], next(fresh)
            cells[f"{name}_not"] = gate("$_NOT_", A=pins["T"], Y=low)
            cells[f"{name}_in"] = gate("$_BUF_", A=pins["IO"], Y=pins["O"])
        else:
            continue
        if data != "0":
            raise tools.Failed(f"{pad} is driven high")
        del cells[name]
        ports[pad]["direction"] = "input"
        ports[f"{pad}_pulled"] = {"direction": "output", "bits": [low]}
    if pads:
        raise tools.Failed(f"{', '.join(pads.values())}: no pad was found")


def gate(kind, **pins):
    return made(kind, {pin: [bit] for pin, bit in pins.items()}, ("Y",))


def made(kind, connections, outputs):
    """A cell of Yosys' JSON."""
    return {"type": kind, "parameters": {}, "attributes": {}, "hide_name": 1, "connections": connections,
            "port_directions": {pin: "output" if pin in outputs else "input" for pin in connections}}


def netlist(rtl, generics, family):
    """The design mapped to the family's cells, in the gates that replay.cpp knows; gives the file. What was mapped before
    is taken from the cache."""
    root, name = tools.root_of("trixie"), f"replayed-{family}"
    text = build.verilog(root, name, rtl, generics).read_bytes()
    # What stands in the Verilog comes from the design alone
    made_by = [text, build.SYNTHESIS[family].encode(), (tools.FPGA / "tools.txt").read_bytes(),
               Path(__file__).read_bytes()]
    kept = tools.ROOTS / "netlists" / hashlib.sha256(b"\0".join(made_by)).hexdigest()
    if not kept.exists():
        build.synthesise(root, name, family)
        kept.parent.mkdir(exist_ok=True)
        shutil.move(gates_of(root, name, family), kept)
    return kept


def gates_of(root, name, family):
    """The netlist of the folder `name` in the gates that replay.cpp knows; gives the file."""
    folder = root.work / name
    module = json.loads((folder / "netlist.json").read_text(encoding="utf-8"))["modules"][TOP]
    model_rams(module)
    open_pads(module)
    (folder / "pads.json").write_text(json.dumps({"modules": {TOP: module}}), encoding="utf-8")
    shutil.copy(tools.FPGA / "flow" / "block_ram.v", folder)
    # The cells by the models of their family, down to single gates; nothing is mapped or optimised again but constants
    root.run("yosys", "-q", "-p",
             f"read_verilog {CELLS[family]}; read_verilog -lib {tools.WORK}/{name}/block_ram.v; read_json {tools.WORK}/{name}/pads.json; "
             f"hierarchy -top {TOP} -check; proc; flatten; opt_expr; opt_clean; simplemap; techmap; dffunmap; "
             f"simplemap; opt_expr -full; opt_clean -purge; check -assert; write_json {tools.WORK}/{name}/gates.json")
    gates = json.loads((folder / "gates.json").read_text(encoding="utf-8"))["modules"][TOP]
    file = folder / "gates.txt"
    file.write_text("\n".join(lines_of(gates)) + "\n", encoding="utf-8")
    return file


# Gates by the order of their inputs and what they give for each row of these
TRUTH = {
    "$_BUF_": ("A", lambda a, b, c: a), "$_NOT_": ("A", lambda a, b, c: not a),
    "$_AND_": ("AB", lambda a, b, c: a and b), "$_OR_": ("AB", lambda a, b, c: a or b),
    "$_XOR_": ("AB", lambda a, b, c: a != b), "$_XNOR_": ("AB", lambda a, b, c: a == b),
    "$_NAND_": ("AB", lambda a, b, c: not (a and b)), "$_NOR_": ("AB", lambda a, b, c: not (a or b)),
    "$_ANDNOT_": ("AB", lambda a, b, c: a and not b), "$_ORNOT_": ("AB", lambda a, b, c: a or not b),
    "$_MUX_": ("ABS", lambda a, b, c: b if c else a), "$_NMUX_": ("ABS", lambda a, b, c: not (b if c else a)),
}


def table_of(kind):
    """The truth table as a number: bit a + 2 b + 4 c."""
    return sum(bool(TRUTH[kind][1](row & 1, row >> 1 & 1, row >> 2 & 1)) << row for row in range(8))


def lines_of(module):
    """The text that replay.cpp reads. Nets 0 and 1 are the constants, as they are in Yosys' JSON; an unknown is 0."""
    def net(bit):
        return bit if isinstance(bit, int) else int(bit == "1")

    initial = {}
    for name in module["netnames"].values():
        for bit, value in zip(name["bits"], reversed(name["attributes"].get("init", ""))):
            initial[bit] = value == "1"
    clock = net(module["ports"]["clk"]["bits"][0])
    gates, lines, highest = [], [], 1
    for name, cell in module["cells"].items():
        kind = cell["type"]
        pins = {pin: [net(bit) for bit in bits] for pin, bits in cell["connections"].items()}
        highest = max([highest, *(bit for bits in pins.values() for bit in bits)])
        if kind in TRUTH:
            inputs = [pins[pin][0] for pin in TRUTH[kind][0]]
            gates.append((table_of(kind), inputs + [0] * (3 - len(inputs)), pins["Y"][0]))
        elif kind == "$_DFF_P_" and pins["C"] == [clock]:
            lines.append(f"f {pins['D'][0]} {pins['Q'][0]} {int(initial.get(pins['Q'][0], False))}")
        elif kind == "block_ram" and pins["write_clock"] == pins["read_clock"] == [clock]:
            order = ("write", "lanes", "write_address", "write_data", "read", "read_address", "read_data")
            lines.append("r " + " ".join(str(bit) for pin in order for bit in pins[pin]))
        elif kind != "$scopeinfo":
            raise tools.Failed(f"{name}: a {kind} on this clock is not known")
    for name, port in module["ports"].items():
        highest = max(highest, net(port["bits"][0]))
        lines.append(f"{port['direction'][0]} {name} {net(port['bits'][0])}")
    depths = depths_of(gates)
    lines += [f"g {table} {' '.join(map(str, inputs))} {output} {depths[output]}" for table, inputs, output in gates]
    return [f"n {highest + 1}", *lines]


def depths_of(gates):
    """{net: how many gates lie before it}; a loop is an error."""
    drivers = {output: inputs for _, inputs, output in gates}
    order = graphlib.TopologicalSorter({output: [bit for bit in inputs if bit in drivers]
                                        for output, inputs in drivers.items()})
    depths = {}
    for output in order.static_order():
        depths[output] = 1 + max((depths.get(bit, 0) for bit in drivers[output]), default=0)
    return depths


def program():
    """Compiles replay.cpp, if it is newer than what it was compiled to."""
    source, binary = tools.FPGA / "flow" / "replay.cpp", tools.ROOTS / "replay"
    if not binary.exists() or binary.stat().st_mtime < source.stat().st_mtime:
        result = subprocess.run(["g++", "-std=c++17", "-O2", "-Wall", "-Wextra", "-Werror", "-o", binary, source],
                                capture_output=True, text=True, check=False)
        if result.returncode:
            raise tools.Failed(result.stderr)
    return binary


def replay(gates, trace):
    """(whether every clock agreed, what the program said)."""
    result = subprocess.run([program(), gates, trace], capture_output=True, text=True, check=False)
    return result.returncode == 0, (result.stdout + result.stderr).strip()
