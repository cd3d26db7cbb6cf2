# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""iCE40 configurations as text (.asc, of nextpnr and iceunpack), and what they say of pins."""

import re
import sys
from pathlib import Path

# Bits of an I/O tile that switch the pull-ups of its two pins off, as (row, column): REN_0 and REN_1 of IceStorm
NO_PULL = ((6, 2), (1, 3))


def tiles_of(text):
    """{(kind, x, y): rows of bits} of a configuration; tiles without a bit are left out."""
    found = {}
    for kind, x, y, rows in re.findall(r"^\.(\w+) (\d+) (\d+)\n((?:[01a-f]+\n)+)", text, re.MULTILINE):
        if set(rows) - set("0\n"):
            found[kind, int(x), int(y)] = rows.split()
    return found


class Pads:
    """Where IceStorm's database has the pins of a part."""

    def __init__(self, database, part, package):
        sys.path.insert(0, str(database))
        import icebox
        self.places = {pin: (x, y, z) for pin, x, y, z in icebox.pinloc_db[f"{part}-{package}"]}
        self.pulls = {tuple(entry[:3]): tuple(entry[3:]) for entry in icebox.ieren_db[part]}

    def pull_of(self, pin, tiles):
        """Pull of a pin in the tiles of a configuration: these parts have pull-ups only."""
        x, y, index = self.pulls[self.places[pin]]
        row, column = NO_PULL[index]
        tile = tiles.get(("io_tile", x, y))
        return "NONE" if tile and tile[row][column] == "1" else "PULLUP"


def pads_of(root, part, package):
    return Pads(Path(root.folder) / "usr/share/fpga-icestorm/python", part, package)
