# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What GHDL's synthesis made of the design, from its dump: cells."""

import re
from collections import Counter

# Cells that must not come up: a multiplier, a divider, a latch
FORBIDDEN = {"smul", "umul", "sdiv", "udiv", "smod", "umod", "srem", "dlatch", "latch"}


def modules_of(text):
    """{module: [(cell or module, width of its output)]} of the dump."""
    found, stack = {}, []
    for line in text.splitlines():
        match = re.match(r"( *)module \{m\d+\} \\(\S+)", line)
        if match:
            stack = [match.group(2)]
            found[match.group(2)] = []
            continue
        match = re.search(r"instance .*: ([$\\])(\S+)", line)
        if match and stack:
            found[stack[-1]].append([match.group(2), 0, match.group(1) == "\\"])
            continue
        match = re.search(r"outputs .*?\{n\d+w(\d+)\}", line)
        if match and stack and found[stack[-1]]:
            found[stack[-1]][-1][1] = int(match.group(1))
    return found


def count(text, top="lens_sweep_top"):
    """(cells, bits at their outputs) of the whole design, each instance counted."""
    modules = modules_of(text)
    names = {name: name for name in modules}
    cells, bits = Counter(), Counter()

    def visit(module):
        for name, width, is_module in modules[module]:
            if is_module:
                if name in names and name != module:
                    visit(name)
            else:
                cells[name] += 1
                bits[name] += width

    visit(next(name for name in modules if name.startswith(top)))
    return cells, bits
