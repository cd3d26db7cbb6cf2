# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""From FASM to the bits of a 7-series part and back, by prjxray's database.

A feature is `TILE.NAME`, or `TILE.NAME[hi:lo] = N'b...`, one feature for each bit that is set. The database has, for the
type of a tile, the bits of each feature relative to the tile (`segbits_*.db`: frame_bit, with `!` for a bit that must
be 0), and for each tile of a part where its frames begin (`tilegrid.json`). A bit is (frame address, word, bit).
"""

import csv
import json
import re
from functools import cache

FAMILY = "zynq7"
WORDS = 101
# The words' error correction; made by what writes the bitstream
ECC_WORD, ECC_BITS = 50, 13


class Part:
    """The database of one part, for example xc7z020clg400-1."""

    def __init__(self, database, name):
        self.folder = database / FAMILY
        self.name = name
        self.grid = json.loads((self.folder / name.partition("clg")[0] / "tilegrid.json").read_text(encoding="utf-8"))

    def lines(self, file):
        path = self.folder / file
        return path.read_text(encoding="utf-8").splitlines() if path.exists() else []

    @cache
    def features_of(self, tile_type):
        """{feature: (kind of frame, [(set, frame, bit)])} of a type of tile; a feature without bits has none."""
        found = {}
        for file, kind in ((f"segbits_{tile_type.lower()}.db", "CLB_IO_CLK"),
                           (f"segbits_{tile_type.lower()}.block_ram.db", "BLOCK_RAM")):
            for line in self.lines(file):
                name, *bits = line.split()
                places = [(not bit.startswith("!"), *map(int, bit.lstrip("!").split("_"))) for bit in bits]
                found[plain(name.partition(".")[2])] = (kind, places)
        for line in self.lines(f"ppips_{tile_type.lower()}.db"):
            found.setdefault(line.split()[0].partition(".")[2], ("", []))
        return found

    def bits_of(self, tile, feature):
        """[(set, bit)] of one feature of a tile."""
        kind, places = self.features_of(self.grid[tile]["type"])[feature]
        if not places:
            return []
        frames = self.grid[tile]["bits"][kind]
        if "alias" in frames:
            raise ValueError(f"{tile}.{feature}: half tiles at the ends of a column are not read")
        base = int(frames["baseaddr"], 0)
        return [(set_, (base + frame, frames["offset"] + bit // 32, bit % 32)) for set_, frame, bit in places]

    def assemble(self, fasm):
        """The set of bits of a FASM text. A bit that one feature sets and another clears is an error."""
        ones, zeros = {}, {}
        for tile, feature in features(fasm):
            if tile not in self.grid or feature not in self.features_of(self.grid[tile]["type"]):
                raise ValueError(f"{tile}.{feature} is not in the database of {self.name}")
            for set_, bit in self.bits_of(tile, feature):
                (ones if set_ else zeros)[bit] = f"{tile}.{feature}"
        for bit in ones.keys() & zeros.keys():
            raise ValueError(f"{ones[bit]} and {zeros[bit]} do not go together")
        return set(ones)

    def required(self):
        """Features that every bitstream of the part has."""
        return "\n".join(self.lines(f"{self.name}/required_features.fasm"))

    def pull_of(self, pin, bits):
        """PULLUP, PULLDOWN, KEEPER or NONE of a pin, as the bits of a bitstream have it."""
        pins = csv.DictReader(self.lines(f"{self.name}/package_pins.csv"))
        row = next(row for row in pins if row["pin"] == pin)
        half = int(row["site"].rpartition("Y")[2]) % 2
        prefix = f"IOB_Y{half}.PULLTYPE."
        fits = [feature.removeprefix(prefix) for feature in self.features_of(self.grid[row["tile"]]["type"])
                if feature.startswith(prefix)
                and all((bit in bits) == set_ for set_, bit in self.bits_of(row["tile"], feature))]
        return fits[0] if len(fits) == 1 else f"unclear {fits}"


def plain(feature):
    """The database writes an index with one, two or three digits."""
    return re.sub(r"\[0+(\d)", r"[\1", feature)


def features(fasm):
    """(tile, feature) of each feature that is on."""
    for line in fasm.splitlines():
        line = line.partition("#")[0].strip()
        if not line:
            continue
        match = re.fullmatch(r"([^.\s]+)\.([^\s\[]+)(?:\[(\d+)(?::(\d+))?\])?(?:\s*=\s*(?:\d+'b)?([01_]+))?", line)
        if not match:
            raise ValueError(f"not a line of FASM: {line}")
        tile, name, high, low, value = match.groups()
        if high is None:
            if value is None or "1" in value:
                yield tile, name
            continue
        low = int(low if low is not None else high)
        for place, digit in enumerate(reversed((value or "1").replace("_", ""))):
            if digit == "1":
                yield tile, f"{name}[{low + place}]"


def frames_text(bits):
    """The frames that have bits, as xc7frames2bit reads them: address, then 101 words."""
    frames = {}
    for address, word, bit in bits:
        frames.setdefault(address, [0] * WORDS)[word] |= 1 << bit
    return "".join(f"0x{address:08X} " + ",".join(f"0x{word:08X}" for word in frames[address]) + "\n"
                   for address in sorted(frames))


def read_back(text):
    """The set of bits in the output of `bitread -y`."""
    found = set()
    for address, word, bit in re.findall(r"^bit_([0-9a-f]{8})_(\d+)_(\d+)$", text, re.MULTILINE):
        place = int(address, 16), int(word), int(bit)
        if place[1] != ECC_WORD or place[2] >= ECC_BITS:
            found.add(place)
    return found
