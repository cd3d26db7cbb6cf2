#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The bench camera as any client of Aravis sees it: it must be right before anything is held against it."""
import struct
import time
import unittest

import rig

rig.enter_own_network()

import gi  # noqa: E402
try:
    gi.require_version('Aravis', '0.8')
    from gi.repository import Aravis
except ValueError:
    rig.skip('there is no gir1.2-aravis-0.8')

PERIOD_NS = 6410000


class Client:
    """A camera, set up to be triggered by Line0, with buffers to fill."""

    def __init__(self, settings=(), pixel_format=None):
        self.camera = Aravis.Camera.new('127.0.0.1')  # by address: discovery takes a second
        self.device = self.camera.get_device()
        for name, value in {'TriggerSelector': 'FrameStart', 'TriggerMode': 'On', 'TriggerSource': 'Line0',
                            'TriggerOverlap': 'ReadOut', **dict(settings)}.items():
            self.camera.set_string(name, value)
        if pixel_format:
            self.camera.set_pixel_format_from_string(pixel_format)
        self.stream = self.camera.create_stream(None, None)
        for _ in range(20):
            self.stream.push_buffer(Aravis.Buffer.new_allocate(self.camera.get_payload()))
        self.camera.start_acquisition()
        self.wait_until_armed()

    def wait_until_armed(self):
        if self.camera.get_string('TriggerMode') != 'On':
            return
        end = time.monotonic() + 5
        while not self.camera.get_boolean('TriggerArmed'):
            if time.monotonic() > end:
                raise TimeoutError('the camera does not arm its trigger')
            time.sleep(0.005)

    def frames(self, silence=0.3):
        """(id, time, stamp) of each frame, until none has come for `silence` seconds."""
        found = []
        while True:
            buffer = self.stream.timeout_pop_buffer(int(silence * 1e6))
            if buffer is None:
                return found
            if buffer.get_status() != Aravis.BufferStatus.SUCCESS:
                raise RuntimeError(f'an incomplete frame: {buffer.get_status()}')
            data = buffer.get_data()
            size = len(data) // (buffer.get_image_width() * buffer.get_image_height())
            found.append((buffer.get_frame_id(), buffer.get_timestamp(), rig.read_stamp(data[size - 1:64 * size:size])))
            self.stream.push_buffer(buffer)

    def close(self):
        """To be called while the camera is there: to leave one that has gone takes Aravis ten seconds."""
        self.camera.stop_acquisition()
        self.stream = self.device = self.camera = None


def sweep(bench, client, silence=0.3):
    """All frames of the sweeps that the sequencer makes."""
    with rig.Wire(bench.run_line) as run:
        run.drive(1)
        return client.frames(silence)


SMALL = ('--size=160x120', '--stamp')


class BenchCameraTest(unittest.TestCase):

    def test_every_trigger_gives_its_plane(self):
        with rig.BenchCamera(*SMALL, '--sweeps=20', '--first-id=65500') as bench:
            client = Client()
            with rig.Wire(bench.sync_line) as sync:
                frames = sweep(bench, client)
                edges = sync.edges()
            client.close()
            report = bench.stop()
        self.assertEqual([stamp for _, _, stamp in frames], [(s, p) for s in range(20) for p in range(6)])
        self.assertEqual([number for number, _, _ in frames], [*range(65500, 65536), *range(1, 85)])
        self.assertEqual(edges, [when for _, when, (_, plane) in frames if plane == 0])
        steps = [b[1] - a[1] for a, b in zip(frames, frames[1:])]
        self.assertLess(max(abs(step - PERIOD_NS) for step in steps), 1000)
        self.assertEqual((report['triggers'], report['exposed'], report['sent'], report['syncs']), (120, 120, 120, 20))

    def test_faults_are_reported_as_they_are_seen(self):
        with rig.BenchCamera(*SMALL, '--sweeps=40', '--first-id=1', '--lose=~20', '--ignore=31', '--seed=5') as bench:
            client = Client()
            frames = sweep(bench, client)
            client.close()
            report = bench.stop()
        ids = [number for number, _, _ in frames]
        self.assertEqual(sorted(ids + report['lost_ids']), [*range(1, report['exposed'] + 1)])
        self.assertEqual(report['exposed'] + report['ignored'], 240)
        self.assertEqual(report['ignored'], 240 // 31)
        self.assertGreater(report['lost'], 0)
        self.assertEqual(report['sent'], len(frames))

    def test_without_overlap_every_second_trigger_is_missed(self):
        with rig.BenchCamera(*SMALL, '--sweeps=10') as bench:
            client = Client({'TriggerOverlap': 'Off'})
            frames = sweep(bench, client)
            client.close()
            report = bench.stop()
        self.assertEqual([stamp[1] for _, _, stamp in frames], [0, 2, 4] * 10)
        self.assertEqual(report['missed'], 30)

    def test_its_clock_is_its_own(self):
        with rig.BenchCamera(*SMALL, '--sweeps=20', '--clock-offset=-5000000000', '--clock-drift=100') as bench:
            client = Client()
            with rig.Wire(bench.sync_line) as sync:
                frames = sweep(bench, client)
                edges = sync.edges()
            client.close()
        starts = [when for _, when, (_, plane) in frames if plane == 0]
        for edge, start in zip(edges, starts):
            self.assertAlmostEqual(start, edge * (1 + 100e-6) - 5e9, delta=1000)

    def test_client_moves_the_lens(self):
        with rig.BenchCamera(*SMALL, '--lens=register', '--settle=30', wired=False) as bench:
            client = Client({'TriggerSource': 'Software'})
            self.assertEqual(client.camera.get_string('FocusStatus'), 'NotInitialized')
            client.camera.execute_command('OpticControllerInitialize')
            seen = []
            for plane in (0, 1, 5, 2):
                client.camera.set_float('FocalPower', 5.0 - plane)
                began = time.monotonic()
                while client.camera.get_string('FocusStatus') != 'Ready':
                    self.assertLess(time.monotonic() - began, 5)
                client.camera.execute_command('TriggerSoftware')
                seen += [stamp[1] for _, _, stamp in client.frames(0.2)]
            client.close()
            report = bench.stop()
        self.assertEqual(seen, [0, 1, 5, 2])
        self.assertEqual(report['software'], 4)

    def test_pixels_are_of_the_format_that_was_asked_for(self):
        with rig.BenchCamera('--size=160x120', '--sweeps=1') as bench:
            for name, size in {'Mono8': 1, 'Mono10': 2, 'Mono12': 2, 'Mono16': 2, 'BayerRG8': 1, 'RGB8': 3}.items():
                with self.subTest(name):
                    client = Client(pixel_format=name)
                    with rig.Wire(bench.run_line) as run:
                        run.drive(1)
                        data = client.stream.timeout_pop_buffer(2000000).get_data()
                    client.close()
                    self.assertEqual(len(data), 160 * 120 * size)
                    samples = struct.unpack(f'<{len(data) // 2}H', data) if size == 2 else data
                    top = {'Mono10': 1023, 'Mono12': 4095, 'Mono16': 65535}.get(name, 255)
                    self.assertLessEqual(max(samples), top)
                    self.assertGreater(max(samples), top / 2)


if __name__ == '__main__':
    unittest.main()
