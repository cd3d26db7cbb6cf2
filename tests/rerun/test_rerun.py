#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What dff-rerun hands over is what the pipeline gave: test_rerun.py PYTHON, an interpreter that may have rerun-sdk."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SKIP = 77
try:
    import rerun
except ImportError:
    if len(sys.argv) > 1 and os.access(sys.argv[1], os.X_OK) and sys.argv[1] != sys.executable:
        os.execv(sys.argv[1], [sys.argv[1], *sys.argv])
    print('dff-rerun: skipped, as there is no rerun-sdk, which is 170 MB of PyPI: python3 -m venv --system-site-packages build/rerun, '
          'and build/rerun/bin/pip install rerun-sdk==0.41.0')
    sys.exit(SKIP)

import gi  # noqa: E402
import numpy as np  # noqa: E402
from rerun.chunk import RrdReader  # noqa: E402

gi.require_version('Gst', '1.0')
gi.require_version('GstDff', '1.0')
from gi.repository import Gst, GstDff  # noqa: E402

Gst.init(None)
ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / 'pipelines/rerun/dff-rerun'
WIDTH, HEIGHT = 160, 120
SWEEP = (f'lenssweeptestsrc name=camera seed=3 planes=6 near=5 far=0.5 motion=0 num-buffers=18 {{live}} ! '
         f'video/x-raw,format=RGB,width={WIDTH},height={HEIGHT} ! focalstackmux ! tee name=stacks  '
         'stacks. ! queue ! dffdepth {settings} ! tee name=depth  stacks. ! queue ! compose.stack  depth. ! queue ! compose.depth  '
         'aifcompose name=compose ! identity name=aif')
CALIBRATION = f'calibration="{ROOT}/pipelines/studio/dff_studio/rig.yml"'


def sweep(settings, live=''):
    return SWEEP.format(settings=settings, live=live)


def values_of(source, sink):
    """The frames of an appsink in their unit, NaN where not known; and the unit."""
    pipeline = Gst.parse_launch(source)
    pipeline.set_state(Gst.State.PLAYING)
    found, unit = [], None
    while sample := pipeline.get_by_name(sink).emit('try-pull-sample', 60 * Gst.SECOND):
        buffer = sample.get_buffer()
        pixels = np.frombuffer(buffer.extract_dup(0, buffer.get_size()), '<u2').reshape(HEIGHT, WIDTH)
        meta = GstDff.buffer_get_depth_meta(buffer)
        unit = meta.unit
        found.append(np.where(pixels == 0, np.nan, meta.offset + meta.scale * pixels.astype(float)))
    pipeline.set_state(Gst.State.NULL)
    return found, unit


def exact_depth(settings):
    """What dffdepth gives."""
    return values_of(sweep(settings) + '  aif. ! fakesink  depth. ! queue ! appsink name=exact sync=false', 'exact')[0]


def true_metres():
    """Of the simulated scene, which does not move."""
    source = (f'lenssweeptestsrc name=camera seed=3 planes=6 near=5 far=0.5 num-buffers=6 ! video/x-raw,width={WIDTH},height={HEIGHT} ! '
              'fakesink async=false  camera.depth ! queue ! appsink name=truth sync=false')
    values, unit = values_of(source, 'truth')
    return 1 / values[0] if unit == GstDff.DepthUnit.DIOPTRE else 1 / (5 - 0.9 * values[0])  # plane numbers are even in dioptres


def run(*arguments, ends=True):
    """What dff-rerun said, when it is done by itself."""
    done = subprocess.run([sys.executable, PROGRAM, *arguments], stderr=subprocess.PIPE, text=True, timeout=200, check=False)
    if ends and done.returncode != 0:
        raise AssertionError(f'dff-rerun ended with status {done.returncode}: {done.stderr}')
    return done


class Recorded:
    """The columns of an .rrd, read by rerun's own reader."""

    def __init__(self, path):
        self.rows = {}
        for chunk in RrdReader(path).stream():
            batch = chunk.to_record_batch()
            for name, column in zip(batch.schema.names, batch.columns):
                self.rows.setdefault((chunk.entity_path.lstrip('/'), name), []).extend(column)

    def of(self, entity, component):
        """The first of what each row holds."""
        return [row.values[0] if hasattr(row, 'values') else row for row in self.rows.get((entity, component), [])]

    def pixels(self, entity, archetype, kind, shape=(HEIGHT, WIDTH)):
        """In the order of time."""
        times = [row.value for row in self.rows[entity, 'time']]
        pictures = [np.asarray(row.values.to_numpy(), 'u1').view(kind).reshape(shape) for row in self.of(entity, f'{archetype}:buffer')]
        return [picture for _, picture in sorted(zip(times, pictures), key=lambda pair: pair[0])]


class HandsOver(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name, 'sweep.rrd')

    def record(self, settings):
        done = run('--launch', sweep(settings), '--save', self.file)
        subprocess.run([pathlib.Path(sys.executable).with_name('rerun'), 'rrd', 'verify', self.file], check=True, capture_output=True)
        return Recorded(self.file), done.stderr

    def check_metres(self, recorded, values, metres_of):
        found = recorded.pixels('camera/depth', 'DepthImage', '<f4')
        self.assertEqual(len(found), 3)
        for picture, value in zip(found, values, strict=True):
            np.testing.assert_array_equal(picture, np.nan_to_num(metres_of(value), nan=0, posinf=np.inf).astype(np.float32))
        self.assertEqual({meter.as_py() for meter in recorded.of('camera/depth', 'DepthImage:meter')}, {1.0})
        return found

    def test_dioptres_become_metres_before_the_camera(self):
        recorded, said = self.record(CALIBRATION)
        self.assertNotIn('metres', said)
        found = self.check_metres(recorded, exact_depth(CALIBRATION), lambda value: 1 / value)
        error = np.abs(found[-1] / true_metres() - 1)[found[-1] > 0]
        self.assertLess(np.median(error), 0.03)
        # rig.yml is of 640x480: a quarter, and rerun counts from the corner of the first pixel.
        matrix = np.reshape(recorded.of('camera', 'Pinhole:image_from_camera')[0].as_py(), (3, 3)).T
        np.testing.assert_allclose(matrix, [[200, 0, 80], [0, 200, 60], [0, 0, 1]])
        self.assertEqual(recorded.of('camera', 'Pinhole:resolution')[0].as_py(), [WIDTH, HEIGHT])

    def test_millimetres_become_metres(self):
        recorded, said = self.record('unit=millimetre')
        self.assertIn('calibration', said)  # without which there are no points
        self.check_metres(recorded, exact_depth('unit=millimetre'), lambda value: value / 1000)
        self.assertEqual(recorded.of('camera', 'Pinhole:image_from_camera'), [])

    def test_no_metres_are_made_up(self):
        recorded, said = self.record(f'unit=index {CALIBRATION}')
        self.assertIn('no metres are made up', said)
        self.assertEqual(recorded.of('camera/depth', 'DepthImage:meter'), [])
        self.assertIn('no metres are made up', recorded.of('log', 'TextLog:text')[0].as_py())
        exact = exact_depth('unit=index')
        for picture, value in zip(recorded.pixels('camera/depth', 'Image', '<f4'), exact, strict=True):
            np.testing.assert_array_equal(picture, np.nan_to_num(value, nan=-1).astype(np.float32))

    def test_picture_confidence_and_counts_are_there(self):
        recorded, _ = self.record(CALIBRATION)
        self.assertEqual(len(recorded.of('camera/picture', 'EncodedImage:blob')), 3)
        self.assertEqual(bytes(recorded.of('camera/picture', 'EncodedImage:blob')[0].as_py())[:2], b'\xff\xd8')
        self.assertEqual(len(recorded.pixels('camera/confidence', 'Image', 'u1')), 3)
        times = [sorted(row.value for row in recorded.rows[f'camera/{name}', 'time']) for name in ('depth', 'picture', 'confidence')]
        self.assertEqual(times[0], times[1])
        self.assertEqual(times[0], times[2])
        stacks = next(name for name, component in recorded.rows if name.startswith('counts/dffdepth') and name.endswith('/stacks'))
        self.assertEqual(max(row.as_py() for row in recorded.of(stacks, 'Scalars:scalars')), 3)

    def test_live_source_until_it_is_told_to_end(self):
        with subprocess.Popen([sys.executable, PROGRAM, '--save', self.file]) as process:
            end = time.monotonic() + 120
            while time.monotonic() < end and (not self.file.exists() or self.file.stat().st_size < 1e6):
                time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(60), 0)
        recorded = Recorded(self.file)
        metres = recorded.pixels('camera/depth', 'DepthImage', '<f4', (480, 640))
        self.assertTrue(0.19 < metres[0][metres[0] > 0].min() and metres[0].max() < 2.1)


class Refuses(unittest.TestCase):
    def test_what_cannot_be(self):
        self.assertEqual(run(ends=False).returncode, 2)
        for arguments in (['--launch', 'fakesrc ! fakesink', '--save', '/dev/null'], ['--save', '/nowhere/sweep.rrd']):
            done = run(*arguments, ends=False)
            self.assertEqual(done.returncode, 1)
            self.assertTrue(done.stderr.strip().splitlines()[-1].startswith('dff-rerun: '), done.stderr)


if __name__ == '__main__':
    unittest.main(argv=['test_rerun.py'])
