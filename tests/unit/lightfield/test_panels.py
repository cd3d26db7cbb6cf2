#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Decodes the panels that lightfieldcompose makes, from what is known of the displays alone."""
import json
import math
import unittest

import numpy as np

import light_field

VIEWS = 45
EYES = (-240, -120, 0, 120, 240)  # where eyes are, in panel pixels from the middle


class Lenticular(unittest.TestCase):
    """A picture whose colour is its column, all at the near end: at x the view v shows the column x + tan(v's angle) height, so
    that each subpixel tells which view it belongs to."""
    WIDTH, HEIGHT, CONE, GAIN = 96, 128, 40.0, 2.0
    DISPLAY = {'pitch': 52.5, 'slope': -7.2, 'center': 0.37, 'viewCone': CONE, 'DPI': 324, 'screenW': WIDTH, 'screenH': HEIGHT,
               'invView': 0, 'flipImageX': 0, 'flipImageY': 0, 'flipSubp': 0}

    def panel(self, display):
        columns = np.arange(256, dtype=np.uint8)
        color = np.repeat(np.tile(columns, (self.HEIGHT, 1))[:, :, None], 3, axis=2)
        depth = np.ones((self.HEIGHT, 256), np.uint16)
        text = json.dumps({name: value if isinstance(value, list) else {'value': float(value)} for name, value in display.items()})
        return light_field.compose(color, depth, f'layout=lenticular zero-parallax=1 depth-gain={self.GAIN}', calibration=text)

    def views_shown(self, panel, flipped):
        """v of each subpixel, by the colours."""
        x = np.arange(self.WIDTH)[None, :, None]
        if flipped:
            x = self.WIDTH - 1 - x
        slope = (panel.astype(float) - (x + (256 - self.WIDTH) / 2)) / (self.GAIN * self.WIDTH)
        return np.degrees(np.arctan(slope)) / self.CONE + 0.5

    def views_due(self, display):
        """v of each subpixel, by the calibration."""
        width, height = self.WIDTH, self.HEIGHT
        pitch = display['pitch'] * width / display['DPI'] * math.cos(math.atan(1 / display['slope']))
        tilt = height / (width * display['slope']) * (-1 if display['flipImageX'] else 1)
        x = (np.arange(width) + 0.5)[None, :, None] / width
        y = 1 - (np.arange(height) + 0.5)[:, None, None] / height
        subpixel = np.array([2, 1, 0] if display['flipSubp'] else [0, 1, 2])[None, None, :]
        shift = subpixel / (3 * width)
        if 'subpixelCells' in display:  # two, in turns along x
            cells = np.array([[(cell[f'{color}OffsetX'] / width + tilt * cell[f'{color}OffsetY'] / height) for color in 'RGB']
                              for cell in display['subpixelCells']])
            shift = cells[np.arange(width) % 2][None, :, :]
        view = (x + shift + y * tilt) * pitch - display['center']
        view -= np.floor(view)
        return 1 - view if display['invView'] else view

    def check(self, **changes):
        display = {**self.DISPLAY, **changes}
        panel = self.panel(display)
        self.assertEqual(panel.shape, (self.HEIGHT, self.WIDTH, 3))
        shown, due = self.views_shown(panel, display['flipImageX']), self.views_due(display)
        inside = (due > 0.01) & (due < 0.99)  # where the views begin anew, rounding decides
        difference = np.abs(shown - due)[inside]
        self.assertLess(difference.max(), 0.5 / VIEWS)
        number_is_right = np.floor(shown * VIEWS) == np.floor(due * VIEWS)
        self.assertGreater(number_is_right[inside].mean(), 0.8)

    def test_each_subpixel_shows_its_view(self):
        self.check()

    def test_inverted_views(self):
        self.check(invView=1)

    def test_flipped_picture_tilts_the_other_way(self):
        self.check(flipImageX=1)

    def test_subpixels_from_blue_to_red(self):
        self.check(flipSubp=1)

    def test_colours_in_cells(self):
        cell = {'ROffsetX': -0.25, 'ROffsetY': -0.31, 'GOffsetX': -0.25, 'GOffsetY': 0.28, 'BOffsetX': 0.25, 'BOffsetY': 0.0}
        mirrored = {name: -offset if name.endswith('X') else offset for name, offset in cell.items()}
        self.check(CellPatternMode=4, subpixelCells=[cell, mirrored])

    def test_lenses_that_lean_to_the_right(self):
        self.check(slope=5.1, center=-0.2)


class Elemental(unittest.TestCase):
    """A near disk on the left, one in the plane of the display in the middle and a far one on the right, looked at through the
    lenses from five places."""
    WIDTH, HEIGHT, PITCH, GAP, DISTANCE, GAIN = 480, 240, 8.25, 20.0, 3000.0, 0.5
    DISKS = {'near': (120, 0.0), 'plane': (240, 0.5), 'far': (360, 1.0)}

    @classmethod
    def setUpClass(cls):
        y, x = np.mgrid[0:cls.HEIGHT, 0:cls.WIDTH]
        cls.color = np.zeros((cls.HEIGHT, cls.WIDTH, 3), np.uint8)
        cls.depth = np.full((cls.HEIGHT, cls.WIDTH), 65535, np.uint16)
        for channel, (center, place) in enumerate(cls.DISKS.values()):
            disk = (x - center) ** 2 + (y - cls.HEIGHT / 2) ** 2 < 40 ** 2
            cls.color[disk, channel] = 255
            cls.depth[disk] = 1 + round(65534 * place)

    def panel(self, properties=''):
        return light_field.compose(self.color, self.depth,
                                   f'layout=elemental pitch={self.PITCH} gap={self.GAP} depth-gain={self.GAIN} {properties}')

    def places(self, panel, eye_x, eye_y=0.0, hexagonal=False):
        """Where the eye sees the middle of each disk, relative to the panel's middle."""
        middle = np.array([self.WIDTH / 2, self.HEIGHT / 2])
        centers = light_field.lens_centers(self.WIDTH, self.HEIGHT, self.PITCH, hexagonal)
        eye = np.array([middle[0] + eye_x, middle[1] + eye_y, self.DISTANCE])
        seen = light_field.seen_by_eye(panel, centers, self.GAP, eye, self.PITCH)
        lit = np.nan_to_num(seen) > 127
        return [centers[lit[:, channel]].mean(axis=0) - middle for channel in range(3)]

    def check_shifts(self, panel, sign=1.0, hexagonal=False):
        for eye_x in EYES:
            places = self.places(panel, eye_x, hexagonal=hexagonal)
            for (center, place), found in zip(self.DISKS.values(), places):
                height = self.GAIN * self.WIDTH * (0.5 - place)
                # The line from the eye to a point of that height meets the plane of the lenses here.
                point = center - self.WIDTH / 2
                lean = (eye_x - point) / (self.DISTANCE - sign * height)
                self.assertAlmostEqual(found[0], point - sign * lean * height, delta=self.PITCH / 2, msg=f'{eye_x} {place}')

    def test_near_things_move_against_the_eye(self):
        panel = self.panel()
        near, plane, far = zip(*((p[0] for p in self.places(panel, eye_x)) for eye_x in EYES))
        self.assertTrue(all(a > b + 2 for a, b in zip(near, near[1:])), near)
        self.assertTrue(all(abs(a - b) < 2 for a, b in zip(plane, plane[1:])), plane)
        self.assertTrue(all(a < b - 2 for a, b in zip(far, far[1:])), far)
        self.check_shifts(panel)

    def test_up_and_down_too(self):
        above, below = (self.places(self.panel(), 0, eye_y)[0][1] for eye_y in (-200, 200))
        self.assertGreater(above, below + 5)

    def test_hexagonal_lenses(self):
        self.check_shifts(self.panel('grid=hex'), hexagonal=True)

    def test_flipped_lenses_turn_the_depth_inside_out(self):
        self.check_shifts(self.panel('flip-lenses=true'), sign=-1.0)


if __name__ == '__main__':
    unittest.main()
