# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Which states and error paths the benches went through. Each simulation adds a line to one file; run.py prints it."""

import atexit
import json
import os
import re
from pathlib import Path

import cocotb
from cocotb.triggers import ValueChange

RTL = Path(os.environ.get("BENCH_RTL", Path(__file__).resolve().parent.parent / "rtl"))
SEEN = {}


def states_of(entity):
    """Names of the enumeration state_t, in order."""
    text = (RTL / f"{entity}.vhd").read_text(encoding="utf-8")
    names = re.search(r"type state_t is\s*\(([^)]*)\)", text).group(1)
    return [name.strip() for name in names.split(",")]


def seen(what, *names):
    SEEN.setdefault(what, set()).update(names)


def watch(entity, signal):
    """Follows a state signal; GHDL shows an enumeration as its number."""
    names = states_of(entity)

    async def follow():
        while True:
            seen(f"{entity} state", names[int(signal.value)])
            await ValueChange(signal)

    cocotb.start_soon(follow())


@atexit.register
def save():
    target = os.environ.get("BENCH_COVERAGE")
    if target and SEEN:
        with open(target, "a", encoding="utf-8") as file:
            file.write(json.dumps({what: sorted(names) for what, names in SEEN.items()}) + "\n")
