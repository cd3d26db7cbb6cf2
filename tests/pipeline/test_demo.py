#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_demo.py SOURCE_ROOT BUILD_ROOT: demo.sh on the folders that people have, and what it says of those that it cannot use."""
import base64
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

SOURCE, BUILD = (pathlib.Path(path) for path in sys.argv[1:3])
SECONDS = 200
SIDE = 96
# A JPEG of 64x64 pixels of cyan 0, magenta 40, yellow 70 and black 10 %, which is RGB 230, 138, 69.
CMYK = base64.b64decode(
    '/9j/7gAOQWRvYmUAZAAAAAAA/9sAQwADAgIDAgIDAwMDBAMDBAUIBQUEBAUKBwcGCAwKDAwLCgsLDQ4SEA0OEQ4LCxAWEBETFBUVFQwPFxgWFBgSFBUU'
    '/8AAFAgAQABABEMRAE0RAFkRAEsRAP/EAB8AAAEFAQEBAQEBAAAAAAAAAAABAgMEBQYHCAkKC//EALUQAAIBAwMCBAMFBQQEAAABfQECAwAEEQUSITFB'
    'BhNRYQcicRQygZGhCCNCscEVUtHwJDNicoIJChYXGBkaJSYnKCkqNDU2Nzg5OkNERUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6g4SFhoeIiYqS'
    'k5SVlpeYmZqio6Slpqeoqaqys7S1tre4ubrCw8TFxsfIycrS09TV1tfY2drh4uPk5ebn6Onq8fLz9PX29/j5+v/aAA4EQwBNAFkASwAAPwD9U69Dr53r'
    '9DaKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKK'
    'KKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKKK'
    'KKKKKKKKKKKKKKKKKKKKKKK//9k=')


def write(path, pixels, orientation=1):
    """An array of rows, columns and channels to a picture."""
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2],
                          oiio.UINT16 if pixels.dtype == np.uint16 else oiio.UINT8)
    spec['Orientation'] = orientation
    spec['CompressionQuality'] = 100
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(pixels) and output.close(), output.geterror()


def flat(value, width=SIDE, height=SIDE, kind=np.uint8):
    return np.full((height, width, 3), value, kind)


def texture(number, kind=np.uint8):
    """Sharp where the picture's number says, so that there is something to align and to measure."""
    pixels = np.random.default_rng(1).integers(60, 200, (SIDE, SIDE, 1))
    blurred = (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1) + np.roll(pixels, (1, 1), (0, 1))) // 4
    columns = np.arange(SIDE)[None, :, None] // (SIDE // 4) == number
    return (np.where(columns, pixels, blurred) * (257 if kind == np.uint16 else 1)).astype(kind)


class Folders(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.photos, self.frames = (pathlib.Path(folder.name, name) for name in ('photos', 'frames'))
        self.photos.mkdir()
        self.frames.mkdir()

    def read(self):
        return subprocess.run([SOURCE / 'pipelines/photographs.py', self.photos, self.frames], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=SECONDS)

    def frames_of(self, kind, channels, width=SIDE, height=SIDE):
        """The frames that were written, without what fills their rows."""
        finished = self.read()
        self.assertEqual(finished.returncode, 0, finished.stderr)
        stride = -(-width * channels * np.dtype(kind).itemsize // 4) * 4
        frames = [np.frombuffer(path.read_bytes(), np.uint8).reshape(height, stride)
                  for path in sorted(self.frames.glob('[0-9][0-9]'))]
        row = width * channels * np.dtype(kind).itemsize
        return [np.ascontiguousarray(frame[:, :row]).view(kind).reshape(height, width, channels) for frame in frames]

    def assert_refused(self, *phrases):
        finished = self.read()
        self.assertEqual(finished.returncode, 1, finished.stdout)
        last = finished.stderr.strip().splitlines()[-1]
        for phrase in phrases:
            self.assertIn(phrase, last)
        self.assertNotIn('Traceback', finished.stderr)


class Reading(Folders):
    def test_order_is_that_in_which_people_count(self):
        names = ['a1.JPG', 'a2.png', 'A3.jpeg', 'a4.tif', 'a10.jpg', 'a11.PNG', 'b1.jpg']
        for level, name in enumerate(names):
            write(self.photos / name, flat(20 + 30 * level))
        (self.photos / '._a1.JPG').write_bytes(b'left by a file manager')
        (self.photos / 'a1.xmp').write_text('<x/>')
        levels = [int(np.median(frame)) for frame in self.frames_of('u1', 3)]
        for level, found in enumerate(levels):
            self.assertAlmostEqual(found, 20 + 30 * level, delta=1)
        self.assertEqual([line.split()[1] for line in self.read().stdout.splitlines()], names)

    def test_colours_of_16_bits_are_right(self):
        for ending in ('png', 'tif'):
            with self.subTest(ending):
                for number in range(2):
                    write(self.photos / f'{number}.{ending}', flat((60000, 30000, 6000), kind=np.uint16))
                for frame in self.frames_of('u1', 3):
                    self.assertLessEqual(np.abs(frame - np.array([60000, 30000, 6000]) / 257).max(), 0.5)
                for path in self.photos.iterdir():
                    path.unlink()

    def test_grey_keeps_its_16_bits(self):
        for ending in ('png', 'tif'):
            with self.subTest(ending):
                ramp = np.arange(SIDE * SIDE, dtype=np.uint16).reshape(SIDE, SIDE, 1) * 7
                for number in range(2):
                    write(self.photos / f'{number}.{ending}', ramp)
                for frame in self.frames_of('<u2', 1):
                    np.testing.assert_array_equal(frame, ramp)
                self.assertIn('GRAY16_LE', (self.frames / 'caps').read_text())

    def test_pictures_are_turned_upright(self):
        upright = np.zeros((80, 100, 3), np.uint8)
        upright[:40, :50], upright[:40, 50:], upright[40:, :50] = (250, 0, 0), (0, 250, 0), (0, 0, 250)
        stored = {1: upright, 2: upright[:, ::-1], 3: upright[::-1, ::-1], 4: upright[::-1], 5: upright.swapaxes(0, 1),
                  6: np.rot90(upright), 7: np.rot90(upright, 2).swapaxes(0, 1), 8: np.rot90(upright, -1)}
        for orientation, pixels in stored.items():
            write(self.photos / f'{orientation}.tif', np.ascontiguousarray(pixels), orientation)
        for orientation, frame in enumerate(self.frames_of('u1', 3, 100, 80), 1):
            np.testing.assert_array_equal(frame, upright, f'orientation {orientation}')

    def test_cmyk_becomes_rgb(self):
        for number in range(2):
            (self.photos / f'{number}.jpg').write_bytes(CMYK)
        for frame in self.frames_of('u1', 3, 64, 64):
            self.assertLessEqual(np.abs(frame - np.array([230, 138, 69])).max(), 3)

    def test_rows_of_odd_widths_and_grey_among_colours(self):
        write(self.photos / '1.png', flat((200, 100, 50), 67, 65))
        write(self.photos / '2.png', flat(90, 67, 65)[:, :, :1])
        colour, grey = self.frames_of('u1', 3, 67, 65)
        self.assertTrue((colour == (200, 100, 50)).all() and (grey == 90).all())


class Refusing(Folders):
    def setUp(self):
        super().setUp()
        for number in range(2):
            write(self.photos / f'{number}.jpg', texture(number).repeat(3, 2))

    def test_files_that_are_cut_empty_or_not_there(self):
        whole = (self.photos / '0.jpg').read_bytes()
        bad = self.photos / '5 "it\'s" 100%\\n.jpg'
        for name, content in (('cut', whole[:len(whole) // 2]), ('empty', b''), ('text', b'no picture')):
            with self.subTest(name):
                bad.write_bytes(content)
                self.assert_refused(bad.name, 'cannot be read: ')
        bad.unlink()
        bad.symlink_to('nowhere')
        self.assert_refused(bad.name, 'cannot be read: ')
        bad.unlink()
        write(self.photos / '7.png', texture(0))
        whole = (self.photos / '7.png').read_bytes()
        (self.photos / '7.png').write_bytes(whole[:len(whole) // 2])
        self.assert_refused('7.png', 'cannot be read: ')

    def test_sizes(self):
        write(self.photos / '2.png', flat(0, 100, SIDE))
        self.assert_refused('2.png is 100x96', '0.jpg is 96x96')
        write(self.photos / '2.png', flat(0, 63, 64))
        self.assert_refused('2.png is 63x64', '64x64 to 8192x8192')
        write(self.photos / '2.png', flat(0, 8193, 64))
        self.assert_refused('2.png is 8193x64', '64x64 to 8192x8192')

    def test_too_few_and_too_many(self):
        (self.photos / '1.jpg').unlink()
        self.assert_refused('photos holds 1 ', '2 to 64')
        for number in range(1, 65):
            shutil.copy(self.photos / '0.jpg', self.photos / f'{number}.jpg')
        self.assert_refused('photos holds 65 ', '2 to 64')

    def test_pages(self):
        spec = oiio.ImageSpec(SIDE, SIDE, 3, oiio.UINT8)
        path = str(self.photos / 'pages.tif')
        output = oiio.ImageOutput.create(path)
        output.open(path, (spec, spec))
        output.write_image(flat(1))
        output.open(path, spec, 'AppendSubimage')
        output.write_image(flat(2))
        output.close()
        self.assert_refused('pages.tif', 'several pages')


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
        self.assertRegex(lines[-1], r'^demo: OK, 1 stack of 4 photographs, \d+ min \d+ s in all, ')
        picture = oiio.ImageInput.open(str(self.checkout / 'demo/all-in-focus.png')).spec()
        self.assertEqual((picture.width, picture.height, picture.nchannels, picture.format), (SIDE, SIDE, 1, oiio.TypeUInt16))
        self.assertEqual(sorted(path.name for path in (self.checkout / 'demo').iterdir()),
                         ['all-in-focus.png', 'depth.png', 'gst-launch.log', 'photographs.log', 'side-by-side.webm'])

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
