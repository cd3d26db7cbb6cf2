#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_stack_reading.py SOURCE_ROOT: what dff-stack reads of the pictures that people have, and what it refuses."""
import itertools
import os
import shutil
import struct
import sys
import time
import unittest

import numpy as np

from gathering import Sweeps
from sweeps import CMYK, CMYK_COLOURS, SIDE, chunk, exif_saying, exif_taken_at, flat, texture, write, write_pages

from dff_stack import Unusable, ahead, encoding, sweep
from dff_stack.progress import Progress


def turned(pixels, orientation):
    """By where EXIF 2.32, 4.6.4, has the first row and the first column: rows are at the top, the bottom, the left or the right."""
    rows_are_columns, from_the_right, from_the_bottom = {1: (0, 0, 0), 2: (0, 1, 0), 3: (0, 1, 1), 4: (0, 0, 1), 5: (1, 0, 0), 6: (1, 1, 0),
                                                         7: (1, 1, 1), 8: (1, 0, 1)}[orientation]
    pixels = pixels.transpose(1, 0, 2) if rows_are_columns else pixels
    return pixels[::-1 if from_the_bottom else 1, ::-1 if from_the_right else 1]


def replace_exif(path, block):
    """Of a PNG file that write() made."""
    path.write_bytes(path.read_bytes().replace(chunk(b'eXIf', exif_saying(1)), chunk(b'eXIf', block)))


class Reading(Sweeps):
    def test_order_is_that_in_which_people_count(self):
        names = ['a1.JPG', 'a2.png', 'A3.jpeg', 'a4.tif', 'a10.jpg', 'a11.PNG', 'b1.jpg']
        for level, name in enumerate(names):
            write(self.photos / name, flat(20 + 30 * level))
        (self.photos / '._a1.JPG').write_bytes(b'left by a file manager')
        (self.photos / 'a1.xmp').write_text('<x/>')
        for level, frame in enumerate(self.frames()[1]):
            self.assertAlmostEqual(int(np.median(frame)), 20 + 30 * level, delta=1)
        self.assertEqual(self.names(), names)
        self.assertEqual(self.names(far_first=True), names[::-1])

    def test_colours_of_16_bits_are_right(self):
        ramp = np.arange(SIDE * SIDE, dtype=np.uint16).reshape(SIDE, SIDE, 1) * 7 + np.array([0, 100, 900], np.uint16)
        for ending in ('png', 'tif'):
            with self.subTest(ending):
                for number in range(2):
                    write(self.photos / f'{number}.{ending}', ramp)
                for frame in self.frames()[1]:
                    self.assertLessEqual(np.abs(frame - ramp / 257).max(), 0.5)
                found, frames = self.frames(has_deep_colour=True)
                self.assertEqual(found.encoding.format, 'RGBA64_LE')
                np.testing.assert_array_equal(frames[0][:, :, :3], ramp)
                np.testing.assert_array_equal(found.encoding.decode(frames[0]), ramp)
                for path in self.photos.iterdir():
                    path.unlink()

    def test_grey_keeps_its_16_bits(self):
        ramp = np.arange(SIDE * SIDE, dtype=np.uint16).reshape(SIDE, SIDE, 1) * 7
        for ending in ('png', 'tif'):
            for number in range(2):
                write(self.photos / f'{number}.{ending}', ramp)
        found, frames = self.frames()
        self.assertEqual(found.encoding.format, 'GRAY16_LE')
        for frame in frames:
            np.testing.assert_array_equal(frame, ramp)

    def test_numbers_with_a_point_keep_their_colours(self):
        light = (np.arange(SIDE * SIDE, dtype=np.float32).reshape(SIDE, SIDE, 1) / 3000) ** 2 * np.array([1, 0.5, 0.1], np.float32)
        for number in range(2):
            write(self.photos / f'{number}.exr', light)
        found, frames = self.frames(has_deep_colour=True)
        np.testing.assert_allclose(found.encoding.decode(frames[0]), light, rtol=0.01, atol=1e-4)
        light[5, 5] = (np.nan, np.inf, -1)
        write(self.photos / '0.exr', light)
        self.assertTrue(np.isfinite(self.frames(has_deep_colour=True)[1][0]).all())

    def test_every_kind_keeps_its_colours(self):
        """8 and 16 bits, grey and colours, with and without transparency, stored in the eight ways that EXIF knows."""
        random = np.random.default_rng(5)
        for ending, kinds, channel_counts in (('png', ('u1', 'u2'), (1, 2, 3, 4)), ('jpg', ('u1',), (1, 3)), ('tif', ('u1', 'u2'), (1, 2, 3, 4))):
            for kind, channels, orientation in itertools.product(kinds, channel_counts, range(1, 9)):
                tones = np.kron(random.uniform(0.2, 0.9, (5, 4, channels)), np.ones((16, 16, 1)))
                pixels = np.round(tones * np.iinfo(kind).max).astype(kind)
                for number in range(2):
                    write(self.photos / f'{number}.{ending}', pixels, orientation)
                with self.subTest(f'{ending}, {kind}, {channels} channels, orientation {orientation}'):
                    self.assert_colours(turned(pixels, orientation)[:, :, :1 if channels < 3 else 3], kind)
            for number in range(2):
                (self.photos / f'{number}.{ending}').unlink()

    def assert_colours(self, expected, kind):
        """To one percent, in the middle of fields of 16x16 pixels."""
        found = sweep.Sweep(self.gather(), True, False)
        formats = {('u1', 1): 'GRAY8', ('u2', 1): 'GRAY16_LE', ('u1', 3): 'RGB', ('u2', 3): 'RGBA64_LE'}
        self.assertEqual(found.encoding.format, formats[kind, expected.shape[2]])
        shown = found.encoding.decode(found.read(0))
        self.assertEqual(shown.shape, expected.shape)
        self.assertLess(np.abs(shown.astype(float) - expected)[8::16, 8::16].max(), 0.01 * np.iinfo(kind).max)

    def test_pictures_are_turned_upright(self):
        upright = np.zeros((80, 100, 3), np.uint8)
        upright[:40, :50], upright[:40, 50:], upright[40:, :50] = (250, 0, 0), (0, 250, 0), (0, 0, 250)
        stored = {1: upright, 2: upright[:, ::-1], 3: upright[::-1, ::-1], 4: upright[::-1], 5: upright.swapaxes(0, 1),
                  6: np.rot90(upright), 7: np.rot90(upright, 2).swapaxes(0, 1), 8: np.rot90(upright, -1)}
        for orientation, pixels in stored.items():
            write(self.photos / f'{orientation}.tif', np.ascontiguousarray(pixels), orientation)
        for orientation, frame in enumerate(self.frames()[1], 1):
            np.testing.assert_array_equal(frame, upright, f'orientation {orientation}')

    def test_cmyk_becomes_rgb_and_is_turned_upright(self):
        side = 32
        for orientation in range(1, 9):
            block = b'Exif\0\0' + exif_saying(orientation)
            for number in range(2):
                (self.photos / f'{number}.jpg').write_bytes(CMYK[:2] + b'\xff\xe1' + struct.pack('>H', len(block) + 2) + block + CMYK[2:])
            expected = turned(np.kron(CMYK_COLOURS, np.ones((side, side, 1))), orientation)
            for frame in self.frames()[1]:
                off = np.abs(frame - expected)[side // 2::side, side // 2::side]
                self.assertLessEqual(off.max(), 3, f'orientation {orientation}')

    def test_an_orientation_that_is_none_is_that_of_the_file(self):
        for name in ('a.jpg', 'b.png', 'c.tif'):
            write(self.photos / name, flat((200, 100, 50), 100, 80), 9)
        for frame in self.frames()[1]:
            self.assertEqual(frame.shape, (80, 100, 3))

    def test_what_exif_says_in_png_is_known(self):
        for number in range(2):
            path = self.photos / f'{number}.png'
            write(path, texture(number))
            replace_exif(path, exif_taken_at(f'2026:01:02 03:04:0{2 - number}'))
        self.assertEqual(self.names(order_='time'), ['1.png', '0.png'])

    def test_exif_in_png_that_is_broken_is_left_alone(self):
        for number, block in enumerate((b'', b'MM', b'MM\0*\xff\xff\xff\xff', exif_saying(1)[:-8], exif_saying(1).ljust(100000, b'\0'))):
            path = self.photos / f'{number}.png'
            write(path, texture(number))
            replace_exif(path, block)
        self.assertEqual(len(self.names()), 5)

    def test_transparency_takes_no_colour(self):
        pixels = np.concatenate([flat((200, 100, 50)), flat(64)[:, :, :1]], 2)
        for number in range(2):
            write(self.photos / f'{number}.png', pixels)
        self.assertTrue((self.frames()[1][0] == (200, 100, 50)).all())

    def test_rows_of_odd_widths_and_grey_among_colours(self):
        write(self.photos / '1.png', flat((200, 100, 50), 67, 65))
        write(self.photos / '2.png', flat(90, 67, 65)[:, :, :1])
        colour, grey = self.frames()[1]
        self.assertTrue((colour == (200, 100, 50)).all() and (grey == 90).all())

    def test_a_raw_file_of_a_camera(self):
        for number in range(2):
            write_dng(self.photos / f'{number}.dng', 200, 100)
        _, frames = self.frames(has_deep_colour=True)
        self.assertEqual(frames[0].dtype, np.uint16)
        self.assertGreater(frames[0][10:-10, 10:-10, :3].mean(), 1000)

    def test_pictures_beside_raw_files_are_the_same_pictures(self):
        for name in ('a', 'b'):
            write_dng(self.photos / f'{name}.DNG', 200, 100)
            write(self.photos / f'{name.upper()}.jpg', flat(9))
        self.assertEqual(self.names(), ['a.DNG', 'b.DNG'])

    def test_results_of_before_are_no_pictures(self):
        for name in ('a', 'b', 'result'):
            write(self.photos / f'{name}.tif', flat(9), **{'software': 'dff-stack 0.1.0'} if name == 'result' else {})
        self.assertEqual(self.names(), ['a.tif', 'b.tif'])
        self.assertIn('result.tif', self.said[0])
        named = self.gather(self.photos, self.photos / 'result.tif')
        self.assertEqual(named[-1].name, 'result.tif')

    def test_pages_are_pictures(self):
        write_pages(self.photos / 'sweep.tif', [flat(50 * number) for number in range(4)])
        write(self.photos / 'sweep2.tif', flat(220))
        self.assertEqual([int(frame[0, 0, 0]) for frame in self.frames()[1]], [0, 50, 100, 150, 220])
        self.assertEqual(self.names()[1], 'sweep.tif, page 2')

    def test_a_small_preview_in_a_file_is_no_picture(self):
        for name in 'ab':
            write_pages(self.photos / f'{name}.tif', [flat(50, 400, 300), flat(50, 80, 60)])
        self.assertEqual(self.names(), ['a.tif', 'b.tif'])


def write_dng(path, width, height):
    """A raw file: 16 bits a pixel behind filters of red, green and blue, not compressed."""
    pixels = (np.arange(width * height, dtype=np.uint16).reshape(height, width) % 977) * 60 + 2000
    identity = [value for row in np.eye(3, dtype=int) for value in row]
    entries = [(254, 4, [0]), (256, 4, [width]), (257, 4, [height]), (258, 3, [16]), (259, 3, [1]), (262, 3, [32803]),
               (271, 2, b'Maker\0'), (272, 2, b'Model\0'), (273, 4, [None]), (274, 3, [1]), (277, 3, [1]), (278, 4, [height]),
               (279, 4, [pixels.nbytes]), (33421, 3, [2, 2]), (33422, 1, bytes([0, 1, 1, 2])), (50706, 1, bytes([1, 4, 0, 0])),
               (50707, 1, bytes([1, 1, 0, 0])), (50708, 2, b'Maker Model\0'), (50721, 10, identity), (50728, 5, [1, 1, 1]),
               (50778, 3, [21])]
    start = 8 + 2 + 12 * len(entries) + 4
    extra, directory = b'', b''
    sizes = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 10: 8}
    for tag, kind, values in entries:
        count = len(values)
        if isinstance(values, bytes):
            data = values
        elif kind in (5, 10):
            data = b''.join(struct.pack('<ii', value, 1) for value in values)
        else:
            data = b''.join(struct.pack('<H' if kind == 3 else '<I', 2048 if value is None else value) for value in values)
        assert len(data) == count * sizes[kind]
        if len(data) > 4:
            directory += struct.pack('<HHII', tag, kind, count, start + len(extra))
            extra += data + b'\0' * (len(data) % 2)
        else:
            directory += struct.pack('<HHI', tag, kind, count) + data.ljust(4, b'\0')
    head = b'II*\0' + struct.pack('<I', 8) + struct.pack('<H', len(entries)) + directory + struct.pack('<I', 0) + extra
    path.write_bytes(head.ljust(2048, b'\0') + pixels.tobytes())


def plain_pages(pages, head):
    """A TIFF file (head HHI) or BigTIFF file (HHHQ) of grey pages with the table of each behind its pixels, as libtiff leaves them."""
    is_big = head == 'HHHQ'
    place, count, entry = ('Q', 'Q', 'HHQQ') if is_big else ('I', 'H', 'HHII')
    data = bytearray(struct.pack('<2sH', b'II', 43 if is_big else 42) + (struct.pack('<HH', 8, 0) if is_big else b''))
    for pixels in pages:
        height, width = pixels.shape[:2]
        link, start = len(data), len(data) + struct.calcsize('<' + place)
        end = start + pixels.nbytes
        data += struct.pack('<' + place, end) + pixels.tobytes()
        tags = {256: width, 257: height, 258: 8, 259: 1, 262: 1, 273: start, 277: 1, 278: height, 279: pixels.nbytes}
        data += struct.pack('<' + count, len(tags)) + b''.join(struct.pack('<' + entry, tag, 4, 1, value) for tag, value in tags.items())
    return bytes(data) + bytes(struct.calcsize('<' + place))


class Refusing(Sweeps):
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
        for ending in ('png', 'tif', 'exr'):
            path = self.photos / f'7.{ending}'
            write(path, texture(0))
            path.write_bytes(path.read_bytes()[:path.stat().st_size // 2])
            with self.subTest(ending):
                self.assert_refused(path.name)
            path.unlink()

    def test_a_page_that_is_cut_off(self):
        path = self.photos / 'a.tif'
        for kind in ('HHI', 'HHHQ'):
            whole = plain_pages([texture(number) for number in range(4)], kind)
            path.write_bytes(whole)
            self.assertEqual(len(self.gather(path)), 4)
            for part in (0.2, 0.3, 0.45, 0.55, 0.8, 0.95):
                path.write_bytes(whole[:int(part * len(whole))])
                self.assert_refused('a.tif cannot be read: ')

    def test_a_pipe_that_nobody_writes_into(self):
        os.mkfifo(self.photos / '5.jpg')
        self.assert_refused('5.jpg cannot be read: it is not a file')

    def test_sizes(self):
        write(self.photos / '2.png', flat(0, 100, SIDE))
        self.assert_refused('2.png is 100x96', '0.jpg is 96x96')
        write(self.photos / '2.png', flat(0, 63, 64))
        self.assert_refused('2.png is 63x64', '64x64')

    def test_too_few(self):
        (self.photos / '1.jpg').unlink()
        self.assert_refused('photos holds 1 picture ', '2 or more')
        (self.photos / '0.jpg').unlink()
        self.assert_refused('photos holds 0 pictures ')
        self.assert_refused('nowhere does not exist', act=lambda: self.gather(self.photos / 'nowhere'))

    def test_floats_among_whole_numbers(self):
        write(self.photos / '2.exr', np.ones((SIDE, SIDE, 3), np.float32))
        self.assert_refused('2.exr', 'point')

    def test_nothing_but_one_picture_again_and_again(self):
        shutil.copy(self.photos / '0.jpg', self.photos / '1.jpg')
        found = sweep.Sweep(self.gather(), False, False)
        look = found.look_through(0, 2 ** 30, Progress(quiet=True))
        self.assert_refused('same', act=lambda: sweep.without_duplicates(found, look, self.said.append))


class BadPixels(Sweeps):
    def write_sweep(self, spots):
        random = np.random.default_rng(4)
        for number in range(6):
            pixels = texture(number % 4).repeat(3, 2)
            for (row, column), value in spots.items():
                pixels[row, column] = value
            if number == 2:
                pixels[50, 50] = 255  # what is bright in one picture only is something sharp
            pixels[0, :6] = random.integers(0, 256, 6)[:, None]
            write(self.photos / f'{number}.png', pixels)

    def test_those_that_stand_out_everywhere_are_mended(self):
        self.write_sweep({(20, 30): 255, (70, 60): 0})
        found, frames = self.frames()
        self.assertEqual([tuple(place) for place in found.bad_pixels], [(20, 30), (70, 60)])
        self.assertEqual(frames[2][50, 50, 0], 255)
        for frame in frames:
            self.assertLess(abs(int(frame[20, 30, 0]) - 130), 75)
            self.assertLess(abs(int(frame[70, 60, 0]) - 130), 75)

    def test_few_pictures_tell_nothing(self):
        self.write_sweep({(20, 30): 255})
        for number in (3, 4, 5):
            (self.photos / f'{number}.png').unlink()
        self.assertEqual(len(self.frames()[0].bad_pixels), 0)


class SideBySide(unittest.TestCase):
    def test_pictures_come_in_their_order(self):
        def late(number):
            time.sleep(0.02 * (number % 3))
            return number

        self.assertEqual(list(ahead.in_order(late, range(12))), list(range(12)))

    def test_what_fails_is_told_where_it_is(self):
        def broken(number):
            if number == 3:
                raise Unusable('the third')
            return number

        found = ahead.in_order(broken, range(12))
        self.assertEqual([next(found) for _ in range(3)], [0, 1, 2])
        with self.assertRaisesRegex(Unusable, 'the third'):
            next(found)


class Shrinking(Sweeps):
    def test_little_memory_keeps_smaller_pictures_for_the_alignment(self):
        for number in range(2):
            write(self.photos / f'{number}.png', flat(9, 1600, 64)[:, :, :1])
        found = sweep.Sweep(self.gather(), False, False)
        whole = 2 * 1600 * 64
        for memory, side in ((4 * whole, 1600), (whole, 800), (1, 533)):
            self.assertEqual(found.small_side(memory), side)
        look = found.look_through(0, whole, Progress(quiet=True))
        self.assertEqual((look.lumas[0].shape, look.factor), ((32, 800), 2))

    def test_luma_is_the_mean_over_squares(self):
        pixels = np.random.default_rng(1).integers(0, 65536, (67, 130, 3)).astype(np.uint16)
        small = encoding.shrunk_luma(pixels, 32)
        self.assertEqual(small.shape, (16, 32))
        self.assertAlmostEqual(float(small[3, 4]), pixels[12:16, 16:20].mean(), delta=0.01)
        preview = sweep.smaller(pixels, 4)
        self.assertEqual(preview.dtype, np.uint16)
        np.testing.assert_allclose(preview[3, 4], pixels[12:16, 16:20].mean((0, 1)), atol=0.5)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
