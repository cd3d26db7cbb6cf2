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

SECONDS = 60
SMALL = 'video/x-raw,format=I420,width=160,height=120'


def launch(pipeline, **variables):
    """Exit status and everything printed."""
    environment = dict(os.environ, GST_DEBUG_NO_COLOR='1', **variables)
    if 'DFF_PRELOAD' in environment:  # gst-launch-1.0 is not built with the sanitizers that our plug-ins want
        environment['LD_PRELOAD'] = environment['DFF_PRELOAD']
    finished = subprocess.run(['gst-launch-1.0', *pipeline.split()], env=environment, text=True, timeout=SECONDS,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return finished.returncode, finished.stdout


class Failures(unittest.TestCase):
    def assert_fails_saying(self, pipeline, *phrases, **variables):
        status, output = launch(pipeline, **variables)
        self.assertGreater(status, 0, output)
        for phrase in phrases:
            self.assertRegex(output, phrase)

    def test_caps_that_cannot_be_linked(self):
        self.assert_fails_saying('videotestsrc num-buffers=1 ! video/x-raw,format=I420 ! dffdepth ! fakesink',
                                 'could not link|not-negotiated')

    def test_property_out_of_range(self):
        self.assert_fails_saying('lenssweeptestsrc planes=1 ! fakesink', 'planes')

    def test_no_opencl_platform(self):
        self.assert_fails_saying(f'lenssweeptestsrc num-buffers=12 ! {SMALL} ! focalstackmux ! dffdepth ! fakesink',
                                 'OpenCL', 'pocl-opencl-icd', OCL_ICD_VENDORS='/nonexistent')

    def test_source_that_stops_in_mid_sweep(self):
        status, output = launch(f'-m lenssweeptestsrc num-buffers=10 planes=6 ! {SMALL} ! focalstackmux ! fakesink')
        self.assertEqual(status, 0, output)

    def test_truncated_stack(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, 'stack.raw')
            path.write_bytes(bytes(160 * 120 * 10 - 7))
            self.assert_fails_saying(
                f'multifilesrc location={path} num-buffers=1 '
                'caps=video/x-focal-stack,format=GRAY8,width=160,height=120,planes=10,framerate=26/1 ! '
                'dffdepth unit=index ! fakesink', '191993', '192000')


if __name__ == '__main__':
    unittest.main()
