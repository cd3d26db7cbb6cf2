#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""An application in Python: takes planes of a (simulated) camera, and changes exposure, gain and rate while it runs."""
import sys
import unittest

import gi

gi.require_version('Gst', '1.0')
gi.require_version('GstApp', '1.0')
gi.require_version('GstDff', '1.0')
from gi.repository import Gst, GstApp, GstDff  # noqa: E402  GstApp gives appsink its methods


class LensSweepSrc(unittest.TestCase):
    def setUp(self):
        self.pipeline = Gst.parse_launch('lenssweepsrc name=camera camera=Fake_1 trigger=free-run planes=3 rate=20 ! '
                                         'appsink name=out sync=false max-buffers=4 drop=true')
        self.camera = self.pipeline.get_by_name('camera')
        self.out = self.pipeline.get_by_name('out')
        self.pipeline.set_state(Gst.State.PLAYING)

    def tearDown(self):
        self.pipeline.set_state(Gst.State.NULL)

    def pull(self):
        sample = self.out.try_pull_sample(10 * Gst.SECOND)
        self.assertIsNotNone(sample)
        return sample

    def test_planes_have_labels(self):
        for _ in range(6):
            buffer = self.pull().get_buffer()
            focus = GstDff.buffer_get_focus_meta(buffer)
            self.assertEqual(focus.planes, 3)
            self.assertLess(focus.plane, 3)
            self.assertAlmostEqual(focus.power, 5 - 2.5 * focus.plane)

    def test_properties_change_while_running(self):
        self.pull()
        self.camera.set_property('exposure', 3000.0)
        self.camera.set_property('gain', 2.0)
        self.camera.set_property('rate', 10.0)
        for _ in range(200):
            sample = self.pull()
            exposure = GstDff.buffer_get_focus_meta(sample.get_buffer()).exposure
            rate = sample.get_caps().get_structure(0).get_fraction('framerate')
            if exposure == 3 * Gst.MSECOND and rate.value_numerator == 30:
                return
        self.fail('nothing changed')

    def test_stats_count_what_was_delivered(self):
        for _ in range(5):
            self.pull()
        stats = self.camera.get_property('stats')
        self.assertGreaterEqual(stats.get_value('delivered'), 5)
        self.assertEqual(stats.get_value('wrong-edges'), 0)

    def test_a_pipeline_can_be_started_again(self):
        for _ in range(3):
            self.pull()
            self.pipeline.set_state(Gst.State.NULL)
            self.pipeline.set_state(Gst.State.PLAYING)
        self.pull()


if __name__ == '__main__':
    Gst.init(sys.argv)
    unittest.main()
