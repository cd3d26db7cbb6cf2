# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Folders of pictures, gathered by dff-stack's own Python, of the source that the first argument of a test names."""
import pathlib
import sys

from sweeps import Folders

sys.path.insert(0, str(pathlib.Path(sys.argv[1], 'pipelines/stack')))
from dff_stack import Unusable, sweep  # noqa: E402
from dff_stack.progress import Progress  # noqa: E402


class Sweeps(Folders):
    def setUp(self):
        super().setUp()
        self.said = []

    def gather(self, *paths, order_='name', far_first=False):
        return sweep.gather(paths or [self.photos], order_, far_first, self.said.append)[0]

    def names(self, **options):
        return [picture.name for picture in self.gather(**options)]

    def frames(self, has_deep_colour=False):
        found = sweep.Sweep(self.gather(), has_deep_colour, False)
        found.look_through(0, 2 ** 30, Progress(quiet=True))
        return found, [found.read(number) for number in range(found.count)]

    def assert_refused(self, *phrases, act=None):
        with self.assertRaises(Unusable) as caught:
            (act or self.frames)()
        for phrase in phrases:
            self.assertIn(phrase, str(caught.exception))
