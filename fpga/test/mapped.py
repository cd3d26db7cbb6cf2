# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The netlists that the mapper makes, and the bitstreams: what is tested of them. Skipped by name where the tools cannot
be had."""

from pathlib import Path

import build
import simulate
import tools

README = Path(__file__).resolve().parent.parent / "README.md"
# As lens_sweep_bench.vhd sets them with SCALE = 2
SCALED = {"CLOCK_HZ": 8_000_000, "TICK_HZ": 2_000_000, "LENS_BUS_HZ": 800_000, "STRETCH_LIMIT_S": "50.0e-6",
          "GLITCH_S": "25.0e-9", "HOST_HOLD_S": "150.0e-9", "HOST_TIMEOUT_S": "12.5e-3"}
# Netlist: family, generics, the benches whose clocks are replayed
REPLAYS = {
    "ecp5": ("ecp5", SCALED, ("contract", "lens_sweep_top", "hundred_tables")),
    "xc7": ("xc7", SCALED, ("contract", "lens_sweep_top", "hundred_tables")),
    "ice40": ("ice40", SCALED, ("contract", "lens_sweep_top", "hundred_tables")),
    "ulx3s": ("ecp5", {"CLOCK_HZ": 25_000_000}, ("one_plane_25_mhz",)),
    "icebreaker": ("ice40", {"CLOCK_HZ": 12_000_000}, ("one_plane_12_mhz",)),
    "arty-z7": ("xc7", {"CLOCK_HZ": 125_000_000}, ("one_plane_125_mhz",)),
}
REPLAYED = {bench for _, _, benches in REPLAYS.values() for bench in benches}
TESTED_BOARDS = ("ulx3s", "icebreaker", "arty-z7-20")


def check(report, rtl, traces):
    """Replays the traces on each netlist."""
    for name, (family, generics, benches) in REPLAYS.items():
        for bench in benches:
            test = f"netlist {name} agrees with the design over {bench}"
            if not traces[bench].exists():
                report.add(f"{test} (the bench left no trace)", False)
                continue
            attempt(report, test, lambda: simulate.replay(simulate.netlist(rtl, generics, family), traces[bench]))


def check_mutation(report, mutation, broken, traces):
    """The netlist of a broken design must not agree with one of the traces."""
    family, generics, benches = REPLAYS[mutation.get("netlist", "ecp5")]

    def differs():
        gates = simulate.netlist(broken, generics, family)
        for bench in benches:
            agrees, said = simulate.replay(gates, traces[bench])
            if not agrees:
                return "should be" in said, f"{bench}, {said}"
        return False, said

    test = f"netlist of {mutation['entity']} shows that {mutation['breaks']}"
    if broken and all(traces[bench].exists() for bench in benches):
        attempt(report, test, differs)
    else:
        report.add(f"{test} (the line is not there once, or a bench left no trace)", False)


def attempt(report, test, run):
    """A test that gives (good, what was said), or cannot be had here."""
    try:
        good, said = run()
        report.add(f"{test}{': ' + said if said else ''}", good)
    except tools.Unavailable as reason:
        report.skip(test, reason)
    except tools.Failed as reason:
        report.add(f"{test}: {reason}", False)


def check_boards(report):
    """A bitstream of each family; its figures are those of the README."""
    for name in TESTED_BOARDS:
        def built():
            line = build.row(name, *build.build(name))
            if line not in README.read_text(encoding="utf-8").splitlines():
                return False, f"the README has not {line}"
            return True, ""

        attempt(report, f"bitstream of {name} closes its timing and has its pulls", built)
