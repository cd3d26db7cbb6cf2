#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_elements.py SOURCE_ROOT: the pages of the elements say what these tell of themselves today."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

DOCS = pathlib.Path(sys.argv[1], 'docs')


class Elements(unittest.TestCase):
    def test_pages_are_what_their_script_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, DOCS / 'elements.py', folder], check=True, timeout=60)
            made = {path.name: path.read_text() for path in pathlib.Path(folder).iterdir()}
        if 'lenssweepsrc.md' not in made or 'depthexrenc.md' not in made:
            self.skipTest('not every element is built')
        written = {path.name: path.read_text() for path in (DOCS / 'elements').glob('*.md')}
        self.maxDiff = None
        self.assertEqual(written, made, 'run docs/elements.py inside meson devenv')


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
