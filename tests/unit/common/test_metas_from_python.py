#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What an application in Python does with the metas and contexts, by gi.repository.GstDff."""
import math
import unittest

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstDff", "1.0")
from gi.repository import GLib, Gst, GstDff  # noqa: E402

Gst.init(None)


class Metas(unittest.TestCase):
    def test_focus_is_read_from_a_buffer(self):
        buffer = Gst.Buffer.new_allocate(None, 16, None)
        self.assertIsNone(GstDff.buffer_get_focus_meta(buffer))
        focus = GstDff.FocusInfo()
        focus.init()
        self.assertTrue(math.isnan(focus.power))
        self.assertEqual(focus.code, -1)
        focus.sweep, focus.plane, focus.planes, focus.power = 7, 3, 6, 1.25
        GstDff.buffer_add_focus_meta(buffer, focus)

        meta = GstDff.buffer_get_focus_meta(buffer)
        self.assertEqual((meta.sweep, meta.plane, meta.planes, meta.power), (7, 3, 6, 1.25))
        self.assertEqual(meta.get_focus().plane, 3)

    def test_a_stack_knows_each_plane(self):
        buffer = Gst.Buffer.new_allocate(None, 16, None)
        stack = GstDff.buffer_add_focal_stack_meta(buffer, 12, 6)
        focus = GstDff.FocusInfo()
        focus.init()
        focus.plane, focus.power = 5, 0.5
        stack.set_focus(5, focus)

        found = GstDff.buffer_get_focal_stack_meta(buffer)
        self.assertEqual((found.sequence, found.planes, found.complete), (12, 6, True))
        has_plane, focus = found.get_focus(5)
        self.assertTrue(has_plane)
        self.assertEqual(focus.power, 0.5)
        self.assertFalse(found.get_focus(6)[0])

    def test_depth_is_read_from_a_buffer(self):
        buffer = Gst.Buffer.new_allocate(None, 16, None)
        depth = GstDff.DepthInfo()
        depth.init()
        depth.unit, depth.near, depth.far = GstDff.DepthUnit.DIOPTRE, 5.0, 0.0
        GstDff.buffer_add_depth_meta(buffer, depth)
        meta = GstDff.buffer_get_depth_meta(buffer)
        self.assertEqual(meta.unit, GstDff.DepthUnit.DIOPTRE)
        self.assertEqual((meta.near, meta.far), (5.0, 0.0))

    def test_a_buffer_that_others_have_too_gets_no_meta(self):
        level = GLib.log_set_always_fatal(GLib.LogLevelFlags.LEVEL_ERROR)
        self.addCleanup(GLib.log_set_always_fatal, level)
        mine = Gst.Buffer.new_allocate(None, 16, None)
        stack = GstDff.buffer_add_focal_stack_meta(mine, 12, 6)
        shared = Gst.Buffer.new_allocate(None, 16, None)
        sample = Gst.Sample.new(shared, None, None, None)
        focus, depth = GstDff.FocusInfo(), GstDff.DepthInfo()
        focus.init()
        depth.init()
        self.assertIsNone(GstDff.buffer_add_focus_meta(shared, focus))
        self.assertIsNone(GstDff.buffer_add_focal_stack_meta(shared, 0, 6))
        self.assertIsNone(GstDff.buffer_add_depth_meta(shared, depth))
        self.assertIsNone(GstDff.buffer_add_focal_stack_meta_from_bytes(shared, stack.to_bytes()))
        self.assertIsNotNone(sample)

    def test_bytes_come_back_and_damaged_ones_raise(self):
        buffer = Gst.Buffer.new_allocate(None, 16, None)
        stack = GstDff.buffer_add_focal_stack_meta(buffer, 12, 6)
        data = stack.to_bytes()
        other = Gst.Buffer.new_allocate(None, 16, None)
        self.assertEqual(GstDff.buffer_add_focal_stack_meta_from_bytes(other, data).sequence, 12)
        with self.assertRaises(GLib.Error):
            GstDff.buffer_add_focal_stack_meta_from_bytes(other, GLib.Bytes.new(data.get_data()[:20]))

    def test_caps_of_a_stack_are_parsed(self):
        caps = Gst.Caps.from_string(
            "video/x-focal-stack,format=GRAY8,width=100,height=10,planes=2,framerate=26/1")
        info = GstDff.FocalStackInfo.new_from_caps(caps)
        self.assertEqual(info.planes, 2)
        self.assertEqual(info.get_size(), 2000)
        with self.assertRaises(TypeError):
            GstDff.FocalStackInfo.new_from_caps(Gst.Caps.from_string("video/x-raw,format=GRAY8"))

    def test_a_device_is_chosen_for_a_pipeline(self):
        context = GstDff.context_new_dff_device("GeForce")
        self.assertEqual(context.get_context_type(), GstDff.DFF_DEVICE_CONTEXT_TYPE)
        self.assertEqual(context.get_structure().get_string("device"), "GeForce")
        pipeline = Gst.Pipeline.new()
        pipeline.set_context(context)
        self.assertEqual(pipeline.get_context(GstDff.DFF_DEVICE_CONTEXT_TYPE).get_structure().get_string("device"), "GeForce")


if __name__ == "__main__":
    unittest.main()
