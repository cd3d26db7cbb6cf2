#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_stack_order.py SOURCE_ROOT: in which order dff-stack takes pictures, and what it says of an order that cannot be."""
import re
import shutil
import sys
import unittest

import numpy as np
import OpenImageIO as oiio

from gathering import Sweeps
from slope import blurred, many_planes, plane
from sweeps import SIDE, flat, texture, write

from dff_stack import order, seriation, sweep
from dff_stack.progress import Progress


class Order(Sweeps):
    def setUp(self):
        super().setUp()
        for number in range(5):
            write(self.photos / f'{number}.tif', texture(number))

    def tell(self, of):
        found = self.gather()
        for number, picture in enumerate(found):
            of(number, picture)
        return found

    def test_distances_that_fall_turn_the_order(self):
        found = [picture for picture in self.gather()]
        for number, picture in enumerate(found):
            picture.distance_m = 1.0 - 0.1 * number
        turned = order.nearest_first(found, 'name', False, self.said.append)
        self.assertEqual(turned, found[::-1])
        self.assertIn('reverse', self.said[0])
        self.assertEqual(order.nearest_first(turned, 'exif-distance', False, self.said.append), found[::-1])

    def test_distances_that_do_not_agree_turn_nothing(self):
        self.assertEqual(order.direction([1, 2, 1, 2, 1]), 0)
        self.assertEqual(order.direction([None, None, None, 2, 1]), 0)
        self.assertEqual(order.direction([3, 2.5, None, 2, 1]), -1)

    def test_by_time(self):
        found = self.tell(lambda number, picture: setattr(picture, 'time', f'2026:01:01 10:00:{50 - number}.'))
        self.assertEqual(order.ordered(found, 'time'), found[::-1])
        found[2].time = ''
        self.assert_refused('2.tif', '--order time', act=lambda: order.ordered(found, 'time'))

    def test_exif_is_read(self):
        spec = oiio.ImageSpec(SIDE, SIDE, 3, oiio.UINT8)
        spec['Exif:SubjectDistance'], spec['Exif:DateTimeOriginal'] = 0.25, '2026:01:01 10:00:00'
        path = self.photos / '0.tif'
        output = oiio.ImageOutput.create(str(path))
        assert output.open(str(path), spec) and output.write_image(flat(9)) and output.close()
        picture = self.gather()[0]
        self.assertAlmostEqual(picture.distance_m, 0.25)
        self.assertTrue(picture.time.startswith('2026:01:01 10:00:00'))

    def test_what_exif_contradicts_is_named(self):
        found = self.tell(lambda number, picture: setattr(picture, 'time', f'2026:01:01 10:00:0{(0, 1, 4, 3, 5)[number]}.'))
        order.tell_of_doubts(found, [], [], self.said.append)
        self.assertIn('3.tif', self.said[0])

    def test_the_same_picture_is_taken_once(self):
        shutil.copy(self.photos / '1.tif', self.photos / '3b.tif')
        found = sweep.Sweep(self.gather(), False, False)
        look = found.look_through(0, 2 ** 30, Progress(quiet=True))
        sweep.without_duplicates(found, look, self.said.append)
        self.assertEqual([picture.name for picture in found.pictures], ['0.tif', '1.tif', '2.tif', '3.tif', '4.tif'])
        self.assertEqual(len(look.lumas), 5)
        self.assertRegex(self.said[0], '3b.tif is the same picture as 1.tif')


def relief(planes, noise):
    """Pictures of a ball on a ground with a hole, brighter and darker, as a camera takes them that is not still."""
    random = np.random.default_rng(6)
    rows, columns = np.indices((160, 240))
    ball = 1 - ((rows - 70) ** 2 + (columns - 90) ** 2) / 60 ** 2
    depth = np.where(ball > 0, 0.7 - 0.7 * np.sqrt(ball.clip(0)), 0.75 + 0.2 * rows / 160)
    depth[90:140, 170:220] = 1
    levels = [random.integers(0, 256, depth.shape).astype(float)]
    for _ in range(24):
        levels.append(blurred(levels[-1], 1))
    for number in range(planes):
        level = np.round(np.abs(depth * (planes - 1) - number) * 24 / (planes - 1)).astype(int)
        picture = np.choose(level, levels) * random.uniform(0.9, 1.1) + random.normal(0, noise, depth.shape)
        yield np.roll(picture.clip(0, 255).astype(np.uint8), tuple(random.integers(-1, 2, 2)), (0, 1))


def slope_of(pictures):
    return [np.round(picture[:, :, 0]).clip(0, 255).astype(np.uint8) for picture in pictures]


class BySharpness(unittest.TestCase):
    """What is told of an order by what is sharp in the pictures."""

    @classmethod
    def setUpClass(cls):
        cls.sweeps = {'slope': slope_of(plane(number) for number in range(6)), 'long slope': slope_of(many_planes()),
                      'ball': list(relief(12, 1)), 'noise': list(relief(24, 8)), 'many': list(relief(150, 3))}

    def told(self, lumas, numbers):
        names = [f'{number}.jpg' for number in numbers]
        return order.doubts_of_sharpness(names, [seriation.sharpness_of(lumas[number]) for number in numbers])

    def each(self):
        return [(lumas, list(range(len(lumas)))) for lumas in self.sweeps.values()]

    def test_no_word_of_sweeps_in_order(self):
        for lumas, numbers in self.each():
            for part in (numbers, numbers[::-1], numbers[::2], numbers[:3], numbers[len(numbers) // 3:]):
                self.assertIsNone(self.told(lumas, part))

    def test_pictures_that_are_astray_are_named(self):
        for lumas, numbers in self.each():
            near, far = len(numbers) // 4, len(numbers) * 3 // 4
            numbers[near], numbers[far] = numbers[far], numbers[near]
            self.assertRegex(self.told(lumas, numbers), rf'^Out of order, it seems: ({near}.jpg and {far}.jpg|{far}.jpg and {near}.jpg)\.')

    def test_neighbours_that_are_swapped(self):
        for name, wrong in (('slope', [0, 1, 3, 2, 4, 5]), ('ball', [0, 1, 2, 3, 4, 6, 5, 7, 8, 9, 10, 11])):
            self.assertRegex(self.told(self.sweeps[name], wrong), r'^Out of order, it seems: [2356]\.jpg\.')

    def test_sweeps_in_two_halves(self):
        for name in ('slope', 'long slope', 'ball'):
            numbers = list(range(len(self.sweeps[name])))
            half, last = len(numbers) // 2, len(numbers) - 1
            for wrong in (numbers[:half] + numbers[half:][::-1], numbers[half:] + numbers[:half]):
                self.assertIn(f'in this order: 0.jpg to {half - 1}.jpg, {half}.jpg to {last}.jpg.', self.told(self.sweeps[name], wrong))

    def test_two_sweeps(self):
        for lumas, numbers in self.each()[1:]:
            there, again = numbers[::2], numbers[1::2]
            for second in (again, again[::-1]):
                told = self.told(lumas, there + second)
                self.assertRegex(told, '^The focus goes through the scene twice')
                turn = int(re.search(r'to (\d+).jpg and from', told)[1])
                self.assertLessEqual(abs((there + second).index(turn) - len(there) + 1), 1, told)

    def test_any_order(self):
        for lumas, numbers in self.each():
            if len(numbers) == 12:  # few enough to look like two sweeps
                continue
            shuffled = [int(number) for number in np.random.default_rng(7).permutation(numbers)]
            self.assertIn('Out of order', self.told(lumas, shuffled))

    def test_noise_alone_has_no_order(self):
        random = np.random.default_rng(3)
        for size, count in (((480, 640), 4), ((600, 800), 10), ((48, 64), 8)):
            lumas = [np.round(100 + random.normal(0, 5, size)).astype(np.uint8) for _ in range(count)]
            self.assertIsNone(self.told(lumas, list(range(count))))

    def test_shake_is_no_order_of_a_fine_long_sweep(self):
        """Shifts change what the parts of a picture show by more than the focus does from picture to picture."""
        random, count, parts = np.random.default_rng(1), 300, 200
        away = np.arange(count)[:, None] - random.uniform(0, count, parts)
        shifts = random.integers(-3, 4, (count, 2)) @ random.standard_normal((2, parts))
        sharpness = 0.05 + 0.1 * np.exp(-(away / 40) ** 2) + random.normal(0, 0.0003, away.shape) + 0.0005 * shifts
        self.assertIsNone(seriation.other_order(sharpness))
        turned = np.r_[0:150, 299:149:-1]
        self.assertIsNotNone(seriation.other_order(sharpness[turned]))

    def test_copies_are_told(self):
        lumas = self.sweeps['noise']
        saved_again = lumas[9] + np.random.default_rng(8).integers(0, 2, lumas[9].shape, np.uint8)
        self.assertEqual(order.copies([*lumas[:10], saved_again, *lumas[10:]]), [9])
        for lumas in self.sweeps.values():
            self.assertEqual(order.copies(lumas), [])


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
