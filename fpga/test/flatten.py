# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""For each entity with records among its ports one without, NAME_flat, which cocotb can drive: GHDL 2 does not show it
records. The element `period` of the port `sweep` is the port `sweep_period`; the entity itself is `dut` in it."""

import re

ENTITY = re.compile(r"entity (\w+) is\n(?:  generic \((.*?)\n  \);\n)?  port \((.*?)\n  \);\nend entity", re.DOTALL)
PORT = re.compile(r"^\s*(\w+)\s*: (in|out|inout)\s+([^;\n]+)", re.MULTILINE)
NAME_OF_GENERIC = re.compile(r"^\s*(\w+)\s*:", re.MULTILINE)


def records_of(package):
    """{record: [(element, type)]} of a package's text."""
    return {name: re.findall(r"^\s*(\w+)\s*: ([^;]+);", elements, re.MULTILINE)
            for name, elements in re.findall(r"type (\w+) is record(.*?)end record", package, re.DOTALL)}


def flat(text, records):
    """(name, text) of the entity without records; None where there is nothing to flatten."""
    found = ENTITY.search(text)
    if not found or not any(kind.strip() in records for _, _, kind in PORT.findall(found.group(3))):
        return None
    entity, generics, ports = found.groups()
    declared, connected = [], []
    for port, mode, kind in PORT.findall(ports):
        elements = records.get(kind.strip())
        for element, element_kind in elements or [(None, kind.strip())]:
            outer = f"{port}_{element}" if element else port
            declared.append(f"    {outer} : {mode} {element_kind}")
            connected.append(f"      {port + '.' + element if element else port} => {outer}")
    names = NAME_OF_GENERIC.findall(generics or "")
    lines = ["library ieee;", "  use ieee.std_logic_1164.all;", "  use ieee.numeric_std.all;", "",
             f"entity {entity}_flat is"]
    lines += [f"  generic ({generics}", "  );"] if generics else []
    lines += ["  port (", ";\n".join(declared), "  );", f"end entity {entity}_flat;", "",
              f"architecture flat of {entity}_flat is", "", "begin", "", f"  dut : entity work.{entity}"]
    lines += ["    generic map (", ",\n".join(f"      {name} => {name}" for name in names), "    )"] if generics else []
    lines += ["    port map (", ",\n".join(connected), "    );", "", "end architecture flat;", ""]
    return f"{entity}_flat", "\n".join(lines)


def write(design, folder):
    """Writes the flat ones of these files into a folder; gives their files."""
    texts = [file.read_text(encoding="utf-8") for file in design]
    records = {name: elements for text in texts for name, elements in records_of(text).items()}
    files = []
    for text in texts:
        made = flat(text, records)
        if made:
            files.append(folder / f"{made[0]}.vhd")
            files[-1].write_text(made[1], encoding="utf-8")
    return files
