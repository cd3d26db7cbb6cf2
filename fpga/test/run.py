#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Runs everything there is to check in fpga/ and prints `N passed, N failed`. Started by run.sh, in its environment.

--only NAME        only benches and checks whose name contains NAME
--all-mutations    break every line listed in mutations.toml, not one for each entity, nor three on netlists
--update-drawings  write the timing diagrams of doc/ anew
"""

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
import xml.etree.ElementTree
from pathlib import Path

from cocotb_tools.runner import get_runner

import flatten
import netlist

TEST = Path(__file__).resolve().parent
FPGA = TEST.parent
sys.path.insert(0, str(FPGA / "flow"))
import mapped  # noqa: E402
import pins  # noqa: E402

RTL = FPGA / "rtl"
HARNESS = TEST / "lens_sweep_bench.vhd"
BUILD = Path(os.environ.get("FPGA_BUILD", FPGA.parent / "build" / "fpga"))
COVERAGE = BUILD / "coverage.jsonl"
FAST = {"CLOCK_HZ": 8_000_000}
REAL = {"CLOCK_HZ": 125_000_000}
SCALED = {"CLOCK_HZ": 8_000_000, "SCALE": 2}
STANDARD = "--std=08"
# An attribute for Vivado, of which GHDL says that it is not for GHDL
FOREIGN_ATTRIBUTE = 'warning: unhandled attribute "async_reg"'
# A bench or check that takes longer hangs
LIMIT_S = 900


class Bench:
    """One simulation: a toplevel with its generics, and the Python module of its tests."""

    def __init__(self, module, toplevel, generics, name=None, **environment):
        self.module, self.toplevel, self.generics = module, toplevel, generics
        self.name = name or module.removeprefix("test_")
        self.environment = {f"BENCH_{key}": str(value) for key, value in environment.items()}
        for key in ("CLOCK_HZ", "SCALE"):
            if key in generics:
                self.environment[f"BENCH_{key}"] = str(generics[key])


ENTITIES = [
    Bench("test_synchronizer", "synchronizer", REAL),
    Bench("test_trigger_output", "trigger_output", FAST),
    Bench("test_i2c_master", "i2c_master", FAST | {"INPUT_CYCLES": 3}),
    Bench("test_i2c_slave", "i2c_slave", FAST),
    Bench("test_register_file", "register_file_flat", FAST),
    Bench("test_plane_table", "plane_table_flat", FAST),
    Bench("test_host_interface", "host_interface_flat", FAST),
    Bench("test_plane_order", "plane_order", {}),
    Bench("test_slot_timer", "slot_timer", FAST),
    Bench("test_sweep_sequencer", "sweep_sequencer_flat", FAST),
]

CHAIN = [
    Bench("test_lens_sweep_top", "lens_sweep_bench", SCALED),
    Bench("test_sweep_exact", "lens_sweep_bench", FAST, "one_real_sweep"),
    Bench("test_sweep_exact", "lens_sweep_bench", REAL, "one_plane_125_mhz", ONE_PLANE=1,
          TESTS="one_plane_at_the_real_clock"),
    Bench("test_sweep_exact", "lens_sweep_bench", {"CLOCK_HZ": 25_000_000}, "one_plane_25_mhz", ONE_PLANE=1,
          TESTS="one_plane_at_the_real_clock"),
    Bench("test_sweep_exact", "lens_sweep_bench", {"CLOCK_HZ": 12_000_000}, "one_plane_12_mhz", ONE_PLANE=1,
          TESTS="one_plane_at_the_real_clock"),
    Bench("test_contract", "lens_sweep_bench", SCALED),
    Bench("test_sweep_exact", "lens_sweep_bench", SCALED, "hundred_sweeps", SWEEPS=100),
    Bench("test_lens_sweep_top", "lens_sweep_bench", SCALED, "hundred_tables", TABLES=100,
          TESTS="random_tables_sweep_as_the_model_says"),
]

BENCHES = ENTITIES + CHAIN

# The timing diagrams of doc/
DRAWINGS = [Bench("scenes", bench.toplevel, bench.generics, f"drawing_{bench.name}", TESTS=bench.name)
            for bench in ENTITIES]
DRAWINGS.append(Bench("scenes", "lens_sweep_bench", FAST, "drawing_lens_sweep_top", TESTS="lens_sweep_top"))


def sources(rtl):
    """Files of sources.txt, in order."""
    lines = (FPGA / "sources.txt").read_text(encoding="utf-8").splitlines()
    files = [line.split()[1] for line in lines if line and not line.startswith("#")]
    return [rtl / Path(file).name for file in files]


def build(rtl, folder, log):
    """Analyses the design into folder; gives the runner."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    design = sources(rtl)
    flat = flatten.write(design, folder)
    runner = get_runner("ghdl")
    runner.build(sources=[*design, *flat, HARNESS], hdl_toplevel="lens_sweep_bench", build_args=[STANDARD],
                 build_dir=folder, always=True, log_file=log)
    for file in flat:
        subprocess.run(["ghdl", "-m", "--work=top", STANDARD, file.stem], cwd=folder, check=True)
    return runner


def simulate(runner, bench, rtl, folder, log, tests=None):
    """Runs one bench; gives {test: passed}. A simulation that ends early has failed whatever it had passed."""
    results = folder / f"{bench.name}.xml"
    results.unlink(missing_ok=True)
    environment = {"PYTHONPATH": str(TEST), "BENCH_RTL": str(rtl), "BENCH_COVERAGE": str(COVERAGE),
                   "BENCH_CASES": str(BUILD), **bench.environment}
    tests = tests or bench.environment.get("BENCH_TESTS")
    parameters = bench.generics | ({"TRACE": str(trace_of(folder, bench))} if bench.name in mapped.REPLAYED else {})
    finished = True
    signal.signal(signal.SIGALRM, give_up)
    signal.alarm(LIMIT_S)
    try:
        runner.test(hdl_toplevel=bench.toplevel, test_module=bench.module, test_args=[STANDARD],
                    elab_args=[], plusargs=["--ieee-asserts=disable-at-0"], parameters=parameters,
                    build_dir=folder, test_dir=folder, extra_env=environment, results_xml=str(results), log_file=log,
                    testcase=tests, seed=1, timescale=None)
    except (RuntimeError, SystemExit, TimeoutError):
        finished = False
    finally:
        signal.alarm(0)
    if not results.exists():
        return {"simulation": False}
    verdict = {}
    for case in xml.etree.ElementTree.parse(results).iter("testcase"):
        if case.find("skipped") is None:
            verdict[case.get("name")] = case.find("failure") is None and case.find("error") is None
    if not finished and all(verdict.values()):
        verdict["simulation"] = False
    return verdict


def trace_of(folder, bench):
    """Where a bench of the chain leaves the pins at every clock."""
    return folder / f"{bench.name}.trace"


def give_up(*_):
    raise TimeoutError


class Report:
    """Counts, and prints as it goes."""

    def __init__(self):
        self.passed = self.failed = self.skipped = 0

    def add(self, name, good, log=None):
        self.passed += good
        self.failed += not good
        print(f"{'PASS' if good else 'FAIL'}  {name}", flush=True)
        if not good and log and log.exists():
            print(excerpt(log, name.rpartition(" ")[2]), flush=True)

    def skip(self, name, reason):
        self.skipped += 1
        print(f"SKIP  {name}: {reason}", flush=True)

    def count(self):
        return f"{self.passed} passed, {self.failed} failed" + (f", {self.skipped} skipped" if self.skipped else "")


def excerpt(log, test):
    """What the log says about one test that failed, or its end."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    first = next((number for number, line in enumerate(lines) if line.endswith(f"{test} failed")), None)
    if first is None:
        return "\n".join("      " + line for line in lines[-30:])
    last = next((number for number in range(first + 1, len(lines)) if " INFO " in lines[number]), len(lines))
    return "\n".join("      " + line.strip() for line in lines[first:last])


def run_command(report, name, command, bad_words=()):
    """A check that is a program: passes if it ends with 0 and prints none of the words."""
    log = BUILD / f"{name.replace(' ', '_')}.log"
    with open(log, "w", encoding="utf-8") as file:
        code = subprocess.run(command, cwd=BUILD, stdout=file, stderr=subprocess.STDOUT, timeout=LIMIT_S,
                              check=False).returncode
    text = log.read_text(encoding="utf-8").lower().replace(FOREIGN_ATTRIBUTE, "")
    report.add(name, code == 0 and not any(word in text for word in bad_words), log)


def check_synthesis(report):
    """GHDL's synthesis as a check only; its netlists are not used (it drops default choices in its Verilog)."""
    work = BUILD / "synthesis"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    files = [str(file) for file in sources(RTL)]
    run_command(report, "analysis without a warning", ["ghdl", "-a", STANDARD, f"--workdir={work}", *files],
                ("warning",))
    run_command(report, "synthesis without a latch or a warning",
                ["ghdl", "--synth", STANDARD, f"--workdir={work}", "--out=none", "lens_sweep_top"],
                ("warning", "latch", "error"))
    dump = subprocess.run(["ghdl", "--synth", STANDARD, f"--workdir={work}", "--out=dump", "lens_sweep_top"],
                          capture_output=True, text=True, check=True).stdout
    cells, _ = netlist.count(dump)
    forbidden = sorted(netlist.FORBIDDEN & set(cells))
    report.add("no divider, multiplier or latch " + " ".join(forbidden), cells["dff"] > 0 and not forbidden)


def check_elaboration(report):
    """The asserts on the generics: the real clock passes, clocks that cannot do it are refused with the reason."""
    work = BUILD / "synthesis"
    for toplevel, clock_hz, reason in (("lens_sweep_top", 125_000_000, ""), ("lens_sweep_top", 12_000_000, ""),
                                       ("lens_sweep_top", 8_000_000, ""),
                                       ("i2c_master", 3_000_000, "at least 10 times the bus rate"),
                                       ("i2c_master", 8_000_000, "synchroniser within the bus-free time"),
                                       ("sweep_sequencer", 12_500_001, "multiple of the rate of the time unit")):
        run = subprocess.run(["ghdl", "-r", STANDARD, f"--workdir={work}", toplevel, f"-gCLOCK_HZ={clock_hz}",
                              "--stop-time=1ns"], cwd=work, capture_output=True, text=True, timeout=LIMIT_S, check=False)
        output = run.stdout + run.stderr
        report.add(f"{toplevel} at {clock_hz} Hz is {'refused' if reason else 'accepted'}",
                   (run.returncode != 0 and reason in output) if reason else run.returncode == 0)


def check_pages(report):
    """Every generic and port of an entity stands on its page."""
    for file in sources(RTL):
        declaration = re.search(r"entity (\w+) is(.*?)end entity", file.read_text(encoding="utf-8"), re.DOTALL)
        if declaration:
            page = (FPGA / "doc" / f"{file.stem}.md").read_text(encoding="utf-8")
            names = re.findall(r"^\s*(\w+)\s*: ", declaration.group(2), re.MULTILINE)
            missing = [name for name in names if f"`{name}`" not in page]
            report.add(f"page of {file.stem} is whole " + " ".join(missing), bool(names) and not missing)
    page = (FPGA / "doc" / "records.md").read_text(encoding="utf-8")
    records = flatten.records_of((RTL / "sweep_types_pkg.vhd").read_text(encoding="utf-8"))
    missing = [name for record, elements in records.items() for name in (record, *(name for name, _ in elements))
               if f"`{name}`" not in page]
    report.add("page of the records is whole " + " ".join(missing), bool(records) and not missing)


def check_constraints(report):
    """Every port of the top has its pin on every board, no pin has two, and buses and `run` have their pulls."""
    top = (RTL / "lens_sweep_top.vhd").read_text(encoding="utf-8")
    ports = re.findall(r"^\s*(\w+)\s*: (?:in|out|inout) ", top, re.MULTILINE)
    wanted = {"run": "PULLDOWN"} | dict.fromkeys(("host_scl", "host_sda", "lens_scl", "lens_sda"), "PULLUP")
    for file in ("arty_z7.xdc", "ulx3s.lpf", "icebreaker.pcf"):
        found = pins.pins_of(file)
        if file.endswith(".pcf"):
            del wanted["run"]  # an iCE40 has no pull-downs: doc/boards.md asks for a resistor
        report.add(f"every port of the top has its pin in {file}",
                   sorted(found) == sorted(ports) and len({pin for pin, _ in found.values()}) == len(ports)
                   and all(found[port][1] == pull for port, pull in wanted.items()))


def mutated(mutation, folder):
    """The design with a line broken, in a folder; None if the line is not there once."""
    rtl = folder / "rtl"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(RTL, rtl)
    file = rtl / f"{mutation['entity']}.vhd"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace(mutation["line"], mutation["becomes"]), encoding="utf-8")
    return rtl if text.count(mutation["line"]) == 1 else None


def check_netlists(report, every):
    """The netlists of the boards' parts show the pins of the design at every clock that the chain was tried with."""
    traces = {bench.name: trace_of(BUILD / "design", bench) for bench in CHAIN if bench.name in mapped.REPLAYED}
    listed = tomllib.loads((TEST / "mutations.toml").read_text(encoding="utf-8"))["mutation"]
    chosen = [mutation for mutation in listed if "hidden" not in mutation
              and (every or "netlist" in mutation or "quick" in mutation)]
    mapped.check(report, RTL, traces)
    for mutation in chosen:
        mapped.check_mutation(report, mutation, mutated(mutation, BUILD / "mutation"), traces)
    mapped.check_boards(report)


def check_mutations(report, every):
    """Breaks a line of an entity and sees its bench fail."""
    listed = tomllib.loads((TEST / "mutations.toml").read_text(encoding="utf-8"))["mutation"]
    done = set()
    for mutation in listed:
        entity = mutation["entity"]
        if entity in done and not every:
            continue
        done.add(entity)
        folder = BUILD / "mutation"
        name = f"bench of {entity} notices: {mutation['breaks']}"
        rtl = mutated(mutation, folder)
        if not rtl:
            report.add(f"{name} (the line is not there, or not once)", False)
            continue
        bench = next(bench for bench in BENCHES if bench.name == mutation.get("bench", entity))
        log = folder / "log"
        try:
            runner = build(rtl, folder / "build", folder / "build.log")
            verdict = simulate(runner, bench, rtl, folder / "build", log, mutation.get("tests"))
        except (RuntimeError, SystemExit, subprocess.CalledProcessError):
            report.add(f"{name} (it does not compile)", False)
            continue
        # A test must have failed; that the simulation did not come about is no proof
        report.add(name, any(not good for test, good in verdict.items() if test != "simulation"))


def print_coverage():
    """States and error paths that the benches went through."""
    seen = {}
    for line in COVERAGE.read_text(encoding="utf-8").splitlines() if COVERAGE.exists() else []:
        for what, names in json.loads(line).items():
            seen.setdefault(what, set()).update(names)
    sys.path.insert(0, str(TEST))
    import coverage
    from words import ERRORS
    wanted = {f"{entity} state": coverage.states_of(entity)
              for entity in ("sweep_sequencer", "i2c_master", "i2c_slave", "plane_table")}
    wanted["error bit"] = ERRORS
    complete = True
    for what, names in wanted.items():
        missing = [name for name in names if name not in seen.get(what, set())]
        complete = complete and not missing
        print(f"coverage: {what}: {len(names) - len(missing)} of {len(names)}"
              + (f", missing {', '.join(missing)}" if missing else ""))
    return complete


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="")
    parser.add_argument("--all-mutations", action="store_true")
    parser.add_argument("--update-drawings", action="store_true")
    options = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    COVERAGE.unlink(missing_ok=True)
    report = Report()

    if options.only in "registers":
        run_command(report, "generated files are current", [sys.executable, str(FPGA / "generate.py"), "--check"])
    if options.only in "flow":
        run_command(report, "what stands between the tools", [sys.executable, "-m", "pytest", "-q", "-p",
                                                              "no:cacheprovider", str(TEST / "test_flow.py")])
    if options.only in "pages":
        check_pages(report)
    if options.only in "constraints":
        check_constraints(report)
    if options.only in "synthesis":
        check_synthesis(report)
        check_elaboration(report)
    if options.only in "style":
        run_command(report, "vsg", ["vsg", "-c", str(FPGA / "vsg.yaml"), "-of", "syntastic", "-f",
                                    *(str(file) for file in [*sources(RTL), HARNESS])])
    if options.update_drawings:
        os.environ["BENCH_UPDATE"] = "1"
    # What is replayed on the netlists comes from benches
    benches = [bench for bench in BENCHES + DRAWINGS if options.only in bench.name
               or (options.only in "netlists" and bench.name in mapped.REPLAYED)]
    if benches:
        runner = build(RTL, BUILD / "design", BUILD / "build.log")
        for bench in benches:
            log = BUILD / f"{bench.name}.log"
            for test, good in simulate(runner, bench, RTL, BUILD / "design", log).items():
                report.add(f"{bench.name}: {test}", good, log)
            for line in log.read_text(encoding="utf-8", errors="replace").splitlines():
                if "budget of" in line:
                    print("      " + line[line.index("budget of"):])
    if options.only in "netlists":
        check_netlists(report, options.all_mutations)
    if not options.only:
        report.add("every state and every error bit was seen", print_coverage())
    if options.only in "mutations":
        check_mutations(report, options.all_mutations)

    print(report.count())
    sys.exit(1 if report.failed else 0)


if __name__ == "__main__":
    main()
