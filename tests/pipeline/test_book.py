#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_book.py SOURCE_ROOT: what the documentation names is there, and it names what is there."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])


def anchors(page):
    """As GitHub makes them of headings."""
    headings = re.findall(r'^#+ (.*)$', page.read_text(), re.MULTILINE)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


class Book(unittest.TestCase):
    def test_links_lead_somewhere(self):
        for page in (*ROOT.glob('*.md'), *(ROOT / 'docs').glob('*.md'), ROOT / 'plugins/engine/README.md'):
            for link in re.findall(r'\]\(([^)\s]+)\)', page.read_text()):
                if re.match(r'\w+:', link):
                    continue
                path, _, anchor = link.partition('#')
                target = page.parent / path if path else page
                with self.subTest(page=page.name, link=link):
                    self.assertTrue(target.exists())
                    self.assertTrue(not anchor or anchor in anchors(target))

    def test_every_page_is_found_from_the_readme_or_the_index(self):
        linked = (ROOT / 'docs/README.md').read_text() + (ROOT / 'README.md').read_text().replace('](docs/', '](')
        for page in (ROOT / 'docs').glob('*.md'):
            if page.name != 'README.md':
                self.assertRegex(linked, rf'\]\({re.escape(page.name)}[#)]', 'a page that nobody finds: add it to docs/README.md')

    def test_every_kernel_is_in_the_table(self):
        table = set(re.findall(r'[\w/]+\.cl', (ROOT / 'docs/kernels.md').read_text()))
        files = {str(path.relative_to(ROOT / 'kernels')) for path in (ROOT / 'kernels').rglob('*.cl')}
        self.assertEqual(table, files, 'add it to docs/kernels.md')

    def test_what_contributors_are_told_to_run_is_there(self):
        for path in re.findall(r'(?<![\w/-])(?:tests|pipelines|packaging|plugins)/[\w/.-]*\w', (ROOT / 'CONTRIBUTING.md').read_text()):
            self.assertTrue((ROOT / path).exists(), path)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
