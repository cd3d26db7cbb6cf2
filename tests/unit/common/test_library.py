#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_library.py LIBRARY SYMBOLS GIR: what the C library exports is listed, and what it offers is described with its version."""
import pathlib
import subprocess
import sys
import unittest
import xml.etree.ElementTree

LIBRARY, SYMBOLS, GIR = map(pathlib.Path, sys.argv[1:4])
CORE = '{http://www.gtk.org/introspection/core/1.0}'
DESCRIBED = ('function', 'method', 'constructor', 'record', 'enumeration', 'constant')


class Library(unittest.TestCase):
    def test_its_symbols_are_those_of_the_package(self):
        """A symbol that goes breaks programs that were built with it; one that comes stays for ever."""
        listed = {line.split('@')[0].strip() for line in SYMBOLS.read_text().splitlines()[1:]}
        exported = subprocess.run(['nm', '-D', '--defined-only', '--format=just-symbols', LIBRARY], check=True, text=True,
                                  stdout=subprocess.PIPE).stdout.split()
        self.assertEqual(set(exported), listed)

    def test_what_it_offers_is_described_with_the_version_it_came_in(self):
        namespace = xml.etree.ElementTree.parse(GIR).getroot().find(CORE + 'namespace')
        described = [element for element in namespace.iter() if element.tag.removeprefix(CORE) in DESCRIBED]
        self.assertGreater(len(described), 30)
        for element in described:
            with self.subTest(name=element.get('name')):
                self.assertIsNotNone(element.find(CORE + 'doc'))
                self.assertIsNotNone(element.get('version'))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
