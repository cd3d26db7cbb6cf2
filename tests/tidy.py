#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""clang-tidy over plugins/: tidy.py BUILD, a folder that Meson has configured. Prints the complaints, fails if there are any.

Nine tenths of clang-tidy's time go to the headers of libraries, again for each file. Files of one target are therefore read
together, as one translation unit that includes them; where two have the same name for something of their own, they are read
apart. Clang's static analyzer, which looks into headers only where they are used, but not into included sources, reads each file
by itself.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
together = 12
analyzer_only = '--checks=-bugprone-*,-modernize-*,-performance-*,-readability-*'
no_analyzer = '--checks=-clang-analyzer-*'
no_check = '--checks=-*,bugprone-suspicious-include'  # It must have one.


def commands(build):
    """The sources of plugins/ and how each is compiled, without its own name and output."""
    sources = {}
    for entry in json.loads((build / 'compile_commands.json').read_text()):
        source = (build / entry['file']).resolve()
        if source.is_relative_to(root / 'plugins'):
            arguments = shlex.split(entry['command'].partition(' -MD ')[0])
            sources.setdefault(source, [argument for argument in arguments if argument != 'ccache'])
    return sources


def units(sources):
    """Lists of sources with equal commands."""
    targets = {}
    for source, command in sources.items():
        targets.setdefault((*command, source.suffix), []).append(source)
    for (*command, _), members in targets.items():
        # Two elements, whose functions have the same names, never go together.
        members.sort(key=lambda source: 'G_DEFINE_' not in source.read_text())
        count = -(-len(members) // together)
        for first in range(count):
            yield command, members[first::count]


def run(build, source, checks):
    """clang-tidy's complaints. The compiler's own warnings are the build's to judge."""
    report = subprocess.run(['clang-tidy', '--quiet', f'--config-file={root}/.clang-tidy', '-p', build,
                             '--extra-arg=-Wno-error', checks, source],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    complaints = set(re.findall(r'^.*: (?:error|warning): .*$', report.stdout, re.MULTILINE))
    if report.returncode != 0 and not complaints:
        return {f'clang-tidy failed on {source}: {report.stdout}'}
    return complaints


def write_unit(build, command, members):
    """One translation unit of these sources, with a compile_commands.json beside it."""
    folder = build / 'tidy' / '-'.join(('_'.join(members[0].relative_to(root).parts), str(len(members))))
    folder.mkdir(parents=True, exist_ok=True)
    unit = folder / ('unit' + members[0].suffix)
    # A debug category is a file's own.
    unit.write_text(''.join(f'#include "{source}" // NOLINT(bugprone-suspicious-include)\n#undef GST_CAT_DEFAULT\n'
                            for source in members))
    entry = {'directory': str(build), 'file': str(unit), 'arguments': [*command, str(unit)]}
    (folder / 'compile_commands.json').write_text(json.dumps([entry]))
    return unit


def tidy(build, command, members):
    """Complaints about these sources, together as far as they compile so."""
    if len(members) < 2:
        return run(build, members[0], no_analyzer)
    unit = write_unit(build, command, members)
    clashes = run(unit.parent, unit, no_check)
    if not clashes:
        return run(unit.parent, unit, no_analyzer)
    apart = [source for source in members if any(clash.startswith(f'{source}:') for clash in clashes)] or members[1:]
    rest = [source for source in members if source not in apart] or apart[:1]
    apart = [source for source in members if source not in rest]
    return tidy(build, command, rest) | tidy(build, command, apart)


def analyze(build, _, members):
    return set().union(*(run(build, source, analyzer_only) for source in members))


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = [pool.submit(look, build, *unit) for unit in units(commands(build)) for look in (tidy, analyze)]
    complaints = set().union(*(run.result() for run in runs))
    print(*sorted(complaints), sep='\n')
    return 1 if complaints else 0


sys.exit(main())
