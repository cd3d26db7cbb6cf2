#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Makes the VHDL package, the C++ header and the documentation page of the registers from registers.toml.

generate.py writes the three files; generate.py --check only compares, and fails if one is stale.
Needs the Python package hdl-registers. Its own VHDL generators need a library that is in no registry and words of
32 bits, so the generators here are ours, on its parser and base class.
"""

import sys
from pathlib import Path

from hdl_registers.generator.register_code_generator import RegisterCodeGenerator
from hdl_registers.parser.toml import from_toml

FPGA = Path(__file__).resolve().parent
LICENSE = ("SPDX-License-Identifier: LGPL-2.1-or-later", "Copyright (C) 2026 the gst-plugins-dff authors",
           "Made by fpga/generate.py from fpga/registers.toml; do not edit.")
WORD_BITS = 16


def default_of(register):
    """The word after reset."""
    return sum(int(field.default_value_uint) << field.base_index for field in register.fields)


def mask_of(register):
    """The bits of the word that exist."""
    return sum(((1 << field.width) - 1) << field.base_index for field in register.fields)


def writable(register):
    return register.mode.software_can_write


def aligned(pairs):
    """Lines whose second parts stand below each other."""
    pairs = list(pairs)
    width = max(len(left) for left, _ in pairs)
    return [f"{left:{width}} {right}" for left, right in pairs]


class SweepGenerator(RegisterCodeGenerator):
    """What the three generators share: plain text, without the time-dependent header of hdl-registers."""

    def write(self):
        self.output_file.write_text(self.get_code(), encoding="utf-8")

    def stale(self):
        return not self.output_file.exists() or self.output_file.read_text(encoding="utf-8") != self.get_code()

    def registers(self):
        for register in self.register_list.register_objects:
            used = max(field.base_index + field.width for field in register.fields)
            if used > WORD_BITS:
                raise ValueError(f"{register.name}: {used} bits do not fit a word of {WORD_BITS}")
            yield register


class VhdlPackage(SweepGenerator):
    SHORT_DESCRIPTION = "VHDL package"
    COMMENT_START = "--"
    output_file = FPGA / "rtl" / "sweep_registers_pkg.vhd"

    def get_code(self, **kwargs):
        registers = list(self.registers())
        lines = [f"-- {line}" for line in LICENSE]
        lines += ["", "library ieee;", "  use ieee.std_logic_1164.all;", "", "package sweep_registers_pkg is", "",
                  f"  subtype word_t is std_ulogic_vector({WORD_BITS - 1} downto 0);", "",
                  "  type words_t is array (natural range <>) of word_t;", "",
                  f"  constant WORD_COUNT : positive := {len(registers)};", "", "  -- Word numbers", ""]
        lines += aligned((f"  constant WORD_{register.name.upper()}", f": natural := {register.index};")
                         for register in registers)
        lines += ["", "  -- Fields of one bit: its number", ""]
        lines += aligned((f"  constant {register.name}_{field.name}".upper().replace("CONSTANT", "constant"),
                          f": natural := {field.base_index};")
                         for register in registers for field in register.fields if field.width == 1)
        lines += ["", "  -- Longer fields: their range", ""]
        for register in registers:
            for field in register.fields:
                if field.width > 1:
                    top = field.base_index + field.width - 1
                    lines += [f"  subtype {register.name}_{field.name}_t is natural range {top} downto "
                              f"{field.base_index};", ""]
        lines += self.table("DEFAULTS", "The words after reset", registers, default_of)
        lines += self.table("WRITE_MASKS", "The bits that a host can write", registers,
                            lambda register: mask_of(register) if writable(register) else 0)
        lines += ["end package sweep_registers_pkg;", ""]
        return "\n".join(lines)

    @staticmethod
    def table(name, comment, registers, value):
        """A constant array of one word a register."""
        rows = aligned((f"    WORD_{register.name.upper()}", f'=> x"{value(register):04X}",') for register in registers)
        return [f"  -- {comment}", "", f"  constant {name} : words_t(0 to WORD_COUNT - 1) :=", "  (",
                *rows[:-1], rows[-1].rstrip(","), "  );", ""]


class CppHeader(SweepGenerator):
    SHORT_DESCRIPTION = "C++ header"
    COMMENT_START = "//"
    output_file = FPGA.parent / "plugins" / "lenssweep" / "lens" / "sweep_registers.h"

    def get_code(self, **kwargs):
        registers = list(self.registers())
        lines = [f"/* {LICENSE[0]}", *(f" * {line}" for line in LICENSE[1:])]
        lines[-1] += " */"
        lines += ["/* clang-format off */", "#pragma once", "", "#include <cstdint>", "", "namespace dff::sweep_registers {", "",
                  "/* Bits of a word: `width` bits from bit `shift` up. */", "struct Field {", "    unsigned shift;",
                  "    unsigned width;", "",
                  "    constexpr std::uint16_t mask() const"
                  " { return static_cast<std::uint16_t>(((1u << width) - 1u) << shift); }",
                  "    constexpr std::uint16_t get(std::uint16_t word) const"
                  " { return static_cast<std::uint16_t>((word & mask()) >> shift); }",
                  "    constexpr std::uint16_t place(unsigned value) const"
                  " { return static_cast<std::uint16_t>((value << shift) & mask()); }", "};", "",
                  "/* Number of a word; it is the SMBus command as well. */", "enum class Word : std::uint8_t {"]
        for register in registers:
            lines += [f"    /* {register.description} */", f"    {register.name} = {register.index},"]
        lines += ["};", "", f"inline constexpr unsigned word_count = {len(registers)};", ""]
        for register in registers:
            for field in register.fields:
                lines += [f"/* {field.description} */",
                          f"inline constexpr Field {register.name}_{field.name} {{{field.base_index}, {field.width}}};"]
        lines += ["", "/* Words that have another value than 0 after reset. */"]
        for register in registers:
            if default_of(register):
                lines.append(f"inline constexpr std::uint16_t {register.name}_default = 0x{default_of(register):04x};")
        lines += ["", "} // namespace dff::sweep_registers", ""]
        return "\n".join(lines)


class Page(SweepGenerator):
    SHORT_DESCRIPTION = "Markdown page"
    COMMENT_START = "<!--"
    COMMENT_END = " -->"
    output_file = FPGA / "doc" / "registers.md"

    def get_code(self, **kwargs):
        lines = [f"<!-- {line} -->" for line in LICENSE]
        lines += ["", "# Registers", "", (FPGA / "doc" / "register_rules.md").read_text(encoding="utf-8").rstrip(), "",
                  "| word | name | host | after reset | what it is |", "|---:|---|---|---|---|"]
        for register in self.registers():
            access = "write" if register.mode.shorthand == "wpulse" else "read, write" if writable(register) else "read"
            lines.append(f"| 0x{register.index:02x} | [`{register.name}`](#{register.name}) | {access} "
                         f"| 0x{default_of(register):04x} | {register.description} |")
        for register in self.registers():
            lines += ["", f"## {register.name}", "", f"Word 0x{register.index:02x}. {register.description}", "",
                      "| bits | field | what it is |", "|---|---|---|"]
            for field in register.fields:
                top = field.base_index + field.width - 1
                bits = str(top) if field.width == 1 else f"{top}..{field.base_index}"
                lines.append(f"| {bits} | `{field.name}` | {field.description} |")
        return "\n".join(lines) + "\n"


def main():
    registers = from_toml("sweep_registers", FPGA / "registers.toml")
    generators = [generator(registers, FPGA) for generator in (VhdlPackage, CppHeader, Page)]
    if "--check" in sys.argv[1:]:
        stale = [generator.output_file.name for generator in generators if generator.stale()]
        for name in stale:
            print(f"{name} is stale: run fpga/generate.py")
        sys.exit(1 if stale else 0)
    for generator in generators:
        generator.output_file.parent.mkdir(parents=True, exist_ok=True)
        generator.write()


if __name__ == "__main__":
    main()
