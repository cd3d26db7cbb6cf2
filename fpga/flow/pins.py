# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What the constraints of a board say of its pins."""

import re
from pathlib import Path

CONSTRAINTS = Path(__file__).resolve().parent.parent / "constraints"
PULLS = {"UP": "PULLUP", "DOWN": "PULLDOWN", "NONE": "NONE"}


def pins_of(file):
    """{port: (pin, pull)}, with pulls named as PULLUP, PULLDOWN, NONE."""
    text = (CONSTRAINTS / file).read_text(encoding="utf-8")
    if file.endswith(".xdc"):
        found = re.findall(r"^set_property -dict \{PACKAGE_PIN (\w+) IOSTANDARD LVCMOS33([^}]*)\} \[get_ports (\w+)\]$",
                           text, re.MULTILINE)
        return {port: (pin, next(iter(re.findall(r"PULLTYPE (\w+)", rest)), "NONE")) for pin, rest, port in found}
    if file.endswith(".pcf"):
        found = re.findall(r"^set_io -pullup (yes|no) (\w+) (\w+)$", text, re.MULTILINE)
        return {port: (pin, "PULLUP" if pull == "yes" else "NONE") for pull, port, pin in found}
    sites = dict(re.findall(r'^LOCATE COMP "(\w+)" SITE "(\w+)";$', text, re.MULTILINE))
    pulls = dict(re.findall(r'^IOBUF PORT "(\w+)" PULLMODE=(\w+) IO_TYPE=LVCMOS33\b[^;]*;$', text, re.MULTILINE))
    return {port: (site, PULLS[pulls[port]]) for port, site in sites.items()}
