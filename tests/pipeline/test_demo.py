#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_demo.py SOURCE_ROOT BUILD_ROOT: demo.sh on the folders that people have, and what it says of those that it cannot use."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

import run_pipelines
from sweeps import SECONDS, SIDE, Folders, texture, write

SOURCE, BUILD = (pathlib.Path(path) for path in sys.argv[1:3])


class Demo(Folders):
    """The whole of demo.sh, in a checkout that has the build under test."""

    def setUp(self):
        super().setUp()
        self.checkout = self.photos.parent / 'check out'
        shutil.copytree(SOURCE / 'pipelines', self.checkout / 'pipelines')
        (self.checkout / 'build').symlink_to(BUILD)
        (self.checkout / 'tmp dir').mkdir()

    def demo(self, *arguments):
        """The exit status and the lines it says."""
        environment = {name: value for name, value in os.environ.items() if name not in ('DISPLAY', 'WAYLAND_DISPLAY')}
        environment['TMPDIR'] = str(self.checkout / 'tmp dir')
        finished = subprocess.run([self.checkout / 'pipelines/demo.sh', *arguments], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=SECONDS, env=environment)
        return finished.returncode, finished.stdout.splitlines()

    def test_a_folder_of_any_name_becomes_pictures(self):
        folder = self.photos.rename(self.photos.parent / 'it is 100% "John\'s" \\n stack [1]')
        for number in range(4):
            write(folder / f'p "{number}" %d.png', texture(number, np.uint16))
        status, lines = self.demo(folder)
        self.assertEqual(status, 0, lines)
        self.assertRegex(lines[-1], r'^demo: OK, the pictures of one sweep, \d+ min \d+ s in all, ')
        picture = oiio.ImageInput.open(str(self.checkout / 'demo/all-in-focus.png')).spec()
        self.assertEqual((picture.width, picture.height, picture.nchannels, picture.format), (SIDE, SIDE, 1, oiio.TypeUInt16))
        self.assertEqual(sorted(path.name for path in (self.checkout / 'demo').iterdir()),
                         ['all-in-focus.png', 'depth.png', 'dff-stack.log', 'rocking.webm'])

    def test_the_last_line_names_file_and_reason(self):
        for number in range(3):
            write(self.photos / f'{number}.jpg', texture(number).repeat(3, 2))
        (self.photos / '1.jpg').write_bytes(b'')
        status, lines = self.demo(self.photos)
        self.assertEqual(status, 1)
        self.assertRegex(lines[-1], r'^demo: FAILED: .*/1\.jpg cannot be read: ')
        for arguments, phrase in (([self.photos / 'no such folder'], 'is not a folder'), (['my', 'photos'], 'in quotes')):
            status, lines = self.demo(*arguments)
            self.assertEqual(status, 1)
            self.assertIn(phrase, lines[-1])


class Readme(Folders):
    def test_the_pipeline_for_a_folder_keeps_16_bits_of_grey(self):
        for number in range(10):
            write(self.photos / f'picture-{number}.png', texture(number // 3, np.uint16))
        command = next(command for command in run_pipelines.commands_of(SOURCE / 'README.md')
                       if 'multifilesrc location=picture-' in command)
        subprocess.run(['bash', '-c', command], cwd=self.photos, check=True, stdout=subprocess.DEVNULL, timeout=SECONDS)
        picture = oiio.ImageInput.open(str(self.photos / 'all-in-focus.png')).spec()
        self.assertEqual((picture.nchannels, picture.format), (1, oiio.TypeUInt16))


class Building(unittest.TestCase):
    """build() of setup.sh."""

    def build(self, checkout):
        return subprocess.run(['bash', '-euc', '. "$0"/pipelines/setup.sh; build build', SOURCE], cwd=checkout, check=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=SECONDS).stdout

    def test_a_checkout_that_was_copied_or_moved_builds_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            first, second, third = (pathlib.Path(folder, name) for name in ('first', 'the copy', 'moved'))
            first.mkdir()
            (first / 'meson.build').write_text("project('tiny')\nconfigure_file(output: 'here', configuration: {'a': "
                                               "meson.project_source_root()})\n")
            self.assertNotIn('anew', self.build(first))
            self.assertNotIn('anew', self.build(first))
            shutil.copytree(first, second)
            self.assertIn('anew', self.build(second))
            self.assertIn('the copy', (second / 'build/here').read_text())
            self.assertNotIn('anew', self.build(second))
            first.rename(third)
            self.assertIn('anew', self.build(third))
            self.assertIn('moved', (third / 'build/here').read_text())


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
