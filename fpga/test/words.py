# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Word numbers and field masks by name, straight from registers.toml."""

from pathlib import Path

from hdl_registers.parser.toml import from_toml

REGISTERS = from_toml("sweep_registers", Path(__file__).resolve().parent.parent / "registers.toml").register_objects
WORD = {register.name: register.index for register in REGISTERS}
BIT = {f"{register.name}.{field.name}": 1 << field.base_index for register in REGISTERS for field in register.fields}
WRITABLE = {register.name for register in REGISTERS if register.mode.software_can_write}
DEFAULT = {register.name: sum(int(field.default_value_uint) << field.base_index for field in register.fields)
           for register in REGISTERS}
MASK = {register.name: sum(((1 << field.width) - 1) << field.base_index for field in register.fields)
        for register in REGISTERS}
STAGED = [register.name for register in REGISTERS
          if WORD["planes"] <= register.index <= WORD["lens_commit"]]
ERRORS = [field.name for field in REGISTERS[WORD["error"]].fields]


def errors_of(value):
    """Names of the bits set in the word `error`."""
    return {name for name in ERRORS if value & BIT[f"error.{name}"]}
