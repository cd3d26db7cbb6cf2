#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Configures the project with plug-ins left out, and with what cannot be: test_options.py SOURCE. The results are TAP."""

import subprocess
import sys
import tempfile

# Options, and a part of the error they must end in; None where they can be had.
CASES = [
    (['-Dfocalstack=disabled'], None),
    (['-Ddff=disabled', '-Dlightfield=enabled'], '-Dlightfield=disabled goes with -Ddff=disabled'),
    (['-Ddepthio=disabled', '-Dopenexr=enabled'], '-Dopenexr=disabled goes with -Ddepthio=disabled'),
    (['-Dlenssweep=disabled', '-Daravis=enabled'], '-Daravis=disabled goes with -Dlenssweep=disabled'),
    (['-Dlenssweep=disabled', '-Dgpio=enabled'], '-Dgpio=disabled goes with -Dlenssweep=disabled'),
]


def fault(source, options, error):
    """What is wrong with the configuration, or nothing."""
    with tempfile.TemporaryDirectory() as folder:
        meson = subprocess.run(['meson', 'setup', folder, source, *options], text=True, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT)
    if error is None:
        return '' if meson.returncode == 0 else meson.stdout
    return '' if meson.returncode != 0 and error in meson.stdout else f'no error with "{error}": {meson.stdout}'


def main():
    failed = 0
    print(f'1..{len(CASES)}')
    for number, (options, error) in enumerate(CASES, 1):
        found = fault(sys.argv[1], options, error)
        failed += bool(found)
        print(f'{"not " if found else ""}ok {number} - {" ".join(options)}', *found.splitlines(), sep='\n# ', flush=True)
    sys.exit(failed > 0)


main()
