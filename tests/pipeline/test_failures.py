#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What a user reads when something is wrong: each failure ends within its time and says what to do."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SECONDS = 30
SMALL = 'video/x-raw,format=I420,width=160,height=120'
STACK = 'video/x-focal-stack,format=GRAY8,width=160,height=120,framerate=26/1'


def launch(pipeline, **variables):
    """Exit status and everything printed. The status is None if there was an error and gst-launch-1.0 waits all the same,
    as that of GStreamer 1.22 may when the error comes before it has begun to wait for one."""
    environment = dict(os.environ, GST_DEBUG_NO_COLOR='1', **variables)
    if 'DFF_PRELOAD' in environment:  # gst-launch-1.0 is not built with the sanitizers that our plug-ins want
        environment['LD_PRELOAD'] = environment['DFF_PRELOAD']
    process = subprocess.Popen(['gst-launch-1.0', *pipeline.split()], env=environment, text=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        output, _ = process.communicate(timeout=SECONDS)
        return process.returncode, output
    except subprocess.TimeoutExpired:
        process.kill()
        output, _ = process.communicate()
        if 'ERROR: from element' not in output:
            raise
        return None, output


class Failures(unittest.TestCase):
    def assert_fails_saying(self, pipeline, *phrases, **variables):
        status, output = launch(pipeline, **variables)
        self.assertNotEqual(status, 0, output)
        for phrase in phrases:
            self.assertIn(phrase, output)
        self.assertNotIn('AddressSanitizer', output)

    def stack_file(self, size):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name, 'stack.raw')
        path.write_bytes(bytes(size))
        return path

    def test_frames_where_stacks_are_due(self):
        self.assert_fails_saying('videotestsrc num-buffers=1 ! video/x-raw,format=I420 ! dffdepth ! fakesink',
                                 'could not link', 'dffdepth0')

    def test_stacks_where_frames_are_due(self):
        self.assert_fails_saying(f'multifilesrc location=/dev/null num-buffers=1 caps={STACK},planes=6 ! focalstackmux ! fakesink',
                                 'could not link', 'focalstackmux0')

    def test_one_plane_is_no_stack(self):
        path = self.stack_file(160 * 120)
        self.assert_fails_saying(f'multifilesrc location={path} num-buffers=1 caps={STACK},planes=1 ! dffdepth ! fakesink',
                                 'could not link', 'dffdepth0')

    def test_property_out_of_range_is_named(self):
        for pipeline, name in (('lenssweeptestsrc num-buffers=1 planes=1 ! fakesink', 'planes'),
                               ('lenssweeptestsrc num-buffers=1 blur-step=-2 ! fakesink', 'blur-step'),
                               ('videotestsrc num-buffers=1 ! lenssweeptag planes=65 ! fakesink', 'planes'),
                               ('videotestsrc num-buffers=1 ! focalstackmux planes=65 ! fakesink', 'planes')):
            self.assert_fails_saying(pipeline, f'{name}=', 'is out of range')

    def test_mux_told_another_number_of_planes(self):
        self.assert_fails_saying(f'lenssweeptestsrc num-buffers=12 planes=6 ! {SMALL} ! focalstackmux planes=4 ! fakesink',
                                 'sweeps of 6 planes', 'planes=4')

    def test_missing_picture_of_a_scene(self):
        self.assert_fails_saying('lenssweeptestsrc num-buffers=1 scene=files image=/nonexistent.png depth-map=/nonexistent.png ! fakesink',
                                 'ERROR: from element', '/nonexistent.png')

    def test_no_opencl_platform(self):
        self.assert_fails_saying(f'lenssweeptestsrc num-buffers=12 ! {SMALL} ! focalstackmux ! dffdepth ! fakesink',
                                 'OpenCL', 'pocl-opencl-icd', OCL_ICD_VENDORS='/nonexistent')

    def test_source_that_stops_in_mid_sweep_ends_the_stream(self):
        status, output = launch(f'lenssweeptestsrc num-buffers=10 planes=6 ! {SMALL} ! focalstackmux ! fakesink')
        self.assertEqual(status, 0, output)
        self.assertIn('Got EOS', output)

    def test_truncated_stack_names_both_sizes(self):
        path = self.stack_file(160 * 120 * 10 - 7)
        self.assert_fails_saying(
            f'multifilesrc location={path} num-buffers=1 caps={STACK},planes=10 ! dffdepth unit=index ! fakesink',
            '191993 bytes', '192000')


if __name__ == '__main__':
    unittest.main()
