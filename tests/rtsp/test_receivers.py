#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What is printed for users, as printed: players that are not GStreamer, receive.py, one machine that captures for another."""
import contextlib
import hashlib
import os
import pathlib
import re
import select
import subprocess
import tempfile
import time
import unittest

from rtsp_client import PATIENCE, Server

SWEEPS = 'lenssweeptestsrc seed=3 planes=4 rate=5 near=5 far=1 motion=2 {} ! video/x-raw,format=I420,width=160,height=128'
LIVE = SWEEPS.format('is-live=true')
RIG = (f'{LIVE} ! focalstackmux ! tee name=stacks  stacks. ! queue ! dffdepth ! tee name=depth '
       'stacks. ! queue ! compose.stack  depth. ! queue ! compose.depth  aifcompose name=compose ! identity name=aif')
FRAME_BYTES = 160 * 128 * 2
RECEIVE = pathlib.Path(__file__).parents[2] / 'pipelines/rtsp/receive.py'


def launch(pipeline, *before):
    environment = dict(os.environ)
    if 'DFF_PRELOAD' in environment:  # gst-launch-1.0 is not built with the sanitizers that our plug-ins want
        environment['LD_PRELOAD'] = environment['DFF_PRELOAD']
    return subprocess.Popen([*before, 'gst-launch-1.0', '-q', *pipeline.split()], env=environment)


def wait_for_frames(path, count):
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and (not os.path.exists(path) or os.path.getsize(path) < count * FRAME_BYTES):
        time.sleep(0.1)


def frames_of(path):
    data = pathlib.Path(path).read_bytes()
    return [hashlib.sha256(data[at:at + FRAME_BYTES]).digest() for at in range(0, len(data), FRAME_BYTES)]


@contextlib.contextmanager
def second_machine():
    """Another network namespace, 10.0.0.2, with a cable to this one, 10.0.0.1; yields what to put before its commands."""
    with subprocess.Popen(['unshare', '-n', 'sh', '-c', 'echo; exec sleep 300'], stdout=subprocess.PIPE) as holder:
        holder.stdout.readline()
        there = ['nsenter', '-t', str(holder.pid), '-n']
        for command in ([f'ip link add here type veth peer name there netns {holder.pid}', 'ip addr add 10.0.0.1/24 dev here',
                         'ip link set here up']):
            subprocess.run(command.split(), check=True)
        for command in ['ip addr add 10.0.0.2/24 dev there', 'ip link set there up', 'ip link set lo up']:
            subprocess.run([*there, *command.split()], check=True)
        try:
            yield there
        finally:
            holder.kill()


class Receivers(unittest.TestCase):
    def test_ffmpeg_plays_every_h264_mount(self):
        with Server(RIG) as server:
            for path, protocol in (('/color', 'tcp'), ('/hue', 'udp'), ('/stream', 'tcp'), ('/rgbd', 'tcp')):
                with self.subTest(path=path, protocol=protocol):
                    played = subprocess.run(
                        ['ffmpeg', '-v', 'warning', '-analyzeduration', '500000', '-rtsp_transport', protocol,
                         '-i', server.url(path), '-frames:v', '3', '-f', 'framecrc', '-'],
                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=PATIENCE, check=True, text=True)
                    self.assertEqual(len(re.findall('^0,', played.stdout, re.MULTILINE)), 3)
                    self.assertNotRegex(played.stderr, 'corrupt|conceal')

    def test_ffplay_shows_pictures_to_an_ordinary_user(self):
        with Server(RIG) as server, tempfile.TemporaryDirectory() as home:
            os.chmod(home, 0o777)
            player = subprocess.Popen(
                ['setpriv', '--reuid=nobody', '--regid=nogroup', '--clear-groups', 'env', '-i', f'HOME={home}', f'PATH={os.defpath}',
                 'SDL_VIDEODRIVER=dummy', 'SDL_AUDIODRIVER=dummy', 'ffplay', '-stats', '-analyzeduration', '500000',
                 '-rtsp_transport', 'udp', server.url('/hue')], stderr=subprocess.PIPE, text=True)
            try:
                # Its clock of the pictures it shows, beside what it is late: "  1.25 M-V: -0.035 fd= ...".
                clock = self.first_match(player.stderr, r'(\d+\.\d+) M-V: +-?\d', lambda match: float(match.group(1)) > 0.5)
                self.assertIsNotNone(clock, 'ffplay has shown nothing')
            finally:
                player.kill()
                player.wait()
                player.stderr.close()

    @staticmethod
    def first_match(stream, pattern, wanted):
        """The first wanted match in what a program writes; None at its end or when patience ends."""
        text, end = '', time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if not select.select([stream], [], [], 1)[0]:
                continue
            piece = os.read(stream.fileno(), 4096).decode(errors='replace')
            if not piece:
                return None
            text = (text + piece)[-8192:]
            for match in re.finditer(pattern, text):
                if wanted(match):
                    return match
        return None

    @unittest.skipIf('DFF_PRELOAD' in os.environ, 'Python does not load what is built with sanitizers')
    def test_receive_py_gives_millimetres(self):
        with Server(RIG) as server:
            for path in ('/depth', '/hue'):
                with self.subTest(path=path):
                    printed = subprocess.run(['/usr/bin/python3', RECEIVE, server.url(path), '5'], stdout=subprocess.PIPE,
                                             timeout=2 * PATIENCE, check=True, text=True).stdout
                    nearest = [float(value) for value in re.findall(r'nearest +(\d+) mm', printed)]
                    self.assertEqual(len(nearest), 5, printed)
                    for value in nearest:  # the sweep spans 5 to 1 dioptres
                        self.assertTrue(195 <= value <= 1010, printed)

    def assert_receive_py_ends(self, url, words):
        finished = subprocess.run(['/usr/bin/python3', RECEIVE, url], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  timeout=15)
        self.assertEqual(finished.returncode, 1)
        self.assertIn(words, finished.stderr)

    @unittest.skipIf('DFF_PRELOAD' in os.environ, 'Python does not load what is built with sanitizers')
    def test_receive_py_says_at_once_why_no_frame_comes(self):
        self.assert_receive_py_ends('rtsp://127.0.0.1:1/depth', 'Failed to connect')
        with Server(f'{LIVE} ! identity name=aif') as server:
            self.assert_receive_py_ends(server.url('/depth'), 'Not found')
            self.assert_receive_py_ends(server.url('/color'), 'There is no depth')

    def test_bound_to_all_addresses_it_prints_one_that_others_reach(self):
        with second_machine(), Server(f'{LIVE} ! identity name=planes', address='0.0.0.0') as server:
            self.assertEqual(server.first_url, f'rtsp://10.0.0.1:{server.port}/planes')

    def test_one_machine_captures_for_another(self):
        with tempfile.TemporaryDirectory() as folder, second_machine() as there:
            received, expected = f'{folder}/received', f'{folder}/expected'
            with Server(f'{LIVE} ! identity name=planes', address='10.0.0.1') as server:
                client = launch(f'rtspsrc location={server.url("/planes")} protocols=tcp latency=300 ! rtpgstdepay ! '
                                f'focalstackmux ! dffdepth steady=off ! filesink buffer-mode=unbuffered location={received}', *there)
                wait_for_frames(received, 6)
                client.kill()
                client.wait()
            launch(f'{SWEEPS.format("num-buffers=240")} ! focalstackmux ! dffdepth ! filesink location={expected}').wait(PATIENCE)
            frames = frames_of(received)[:6]
            self.assertEqual(len(frames), 6)
            first = frames_of(expected).index(frames[0])
            self.assertEqual(frames, frames_of(expected)[first:first + 6])


if __name__ == '__main__':
    unittest.main()
