# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What the tests of this folder share: a network of their own, and the bench camera as a child process."""
import json
import os
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

SKIPPED = 77  # what Meson takes for a skip
BENCH_CAMERA = os.environ.get('BENCH_CAMERA', 'bench-camera')
STAMP_MARK = 0xd5


def enter_own_network():
    """Starts this script again in a network namespace with nothing but lo, which discovery cannot leave."""
    if os.environ.get('DFF_RIG_NETWORK') == 'own':
        return
    command = ['unshare', '-n', 'sh', '-c', 'ip link set lo up && exec "$@"', 'sh']
    for tool in ('unshare', 'ip'):
        if not shutil.which(tool):
            skip(f'there is no {tool}: install util-linux and iproute2')
    if subprocess.run(command + ['true'], stderr=subprocess.DEVNULL, check=False).returncode != 0:
        skip('a network namespace of its own needs root')
    os.environ['DFF_RIG_NETWORK'] = 'own'
    os.execvp(command[0], command + [sys.executable, *sys.argv])


def skip(reason):
    print(f'skipped: {reason}')
    sys.exit(SKIPPED)


class BenchCamera:
    """The camera and the wires to its sequencer. A context manager; `report` is what it did, once it has ended."""

    def __init__(self, *options, wired=True):
        self.folder = tempfile.TemporaryDirectory(prefix='dff-rig-')
        self.run_line = f'{self.folder.name}/run'
        self.sync_line = f'{self.folder.name}/sync'
        self.truth = f'{self.folder.name}/truth.png'
        self.options = [*options, f'--truth={self.truth}']
        if wired:
            self.options += [f'--run-line={self.run_line}', f'--sync-line={self.sync_line}']
        self.process = None
        self.report = None

    def start(self):
        environment = dict(os.environ)
        environment.pop('LD_PRELOAD', None)
        self.process = subprocess.Popen([BENCH_CAMERA, *self.options], stdout=subprocess.PIPE, text=True, env=environment)
        readable, _, _ = select.select([self.process.stdout], [], [], 60)
        line = self.process.stdout.readline() if readable else ''
        if line != 'ready\n':
            self.kill()
            raise RuntimeError(f'the bench camera does not start: {line!r}')
        return self

    def stop(self):
        """Ends it and returns its report."""
        if self.process and self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        if self.process:
            output, _ = self.process.communicate(timeout=20)
            self.report = json.loads(output)
            self.process = None
        return self.report

    def kill(self):
        """As if its plug were pulled."""
        self.process.kill()
        self.process.communicate(timeout=20)
        self.process = None

    def __enter__(self):
        return self.start()

    def __exit__(self, *_):
        if self.process:
            try:
                self.stop()
            except (subprocess.TimeoutExpired, ValueError):
                self.kill()
        self.folder.cleanup()


class Wire:
    """This end of a line to the sequencer."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.connect(path)

    def drive(self, level):
        self.socket.send(f'{level} {time.monotonic_ns()}'.encode())

    def edges(self):
        """The times of the edges that have come, in nanoseconds."""
        times = []
        while select.select([self.socket], [], [], 0)[0]:
            packet = self.socket.recv(64)
            if not packet:
                break
            times.append(int(packet.split()[1]))
        return times

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()


def read_stamp(pixels):
    """(sweep, plane) as the bench camera has written it into the first 64 pixels, each 0 or bright; None if it has not."""
    value = 0
    for pixel in pixels:
        value = value << 1 | (pixel > 127)
    content = (value >> 16).to_bytes(6, 'big')
    if content[0] != STAMP_MARK or sum(content) != value & 0xffff:
        return None
    return int.from_bytes(content[2:], 'big'), content[1]
