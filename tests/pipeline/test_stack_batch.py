#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_stack_batch.py SOURCE_ROOT: dff-stack --batch, alone and with workers of which one is killed."""
import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

import numpy as np

from slope import plane
from sweeps import SECONDS, Folders, write

PROGRAM = pathlib.Path(sys.argv[1], 'pipelines/stack/dff-stack')
STACKS = int(os.environ.get('DFF_BATCH_STACKS', '4'))  # more take longer


def alone(command):
    """In a network of its own, in which nothing but this machine is."""
    return ['unshare', '-n', 'sh', '-c', 'ip link set lo up && exec "$@"', 'sh', *command]


def children(pid):
    """Processes that a process has started, and their command lines."""
    found = {}
    for status in pathlib.Path('/proc').glob('[0-9]*/stat'):
        try:
            parent = int(status.read_text().rpartition(')')[2].split()[1])
            if parent == pid:
                found[int(status.parent.name)] = (status.parent / 'cmdline').read_text()
        except (OSError, ValueError):  # it has ended
            continue
    return found


def busy_worker(pid):
    """A worker of Dask that has a dff-stack at work, or None."""
    for child, words in children(pid).items():
        if 'spawn_main' in words and children(child):
            return child
    return None


class Batch(Folders):
    def setUp(self):
        super().setUp()
        self.results = self.photos.parent / 'results'
        for number in range(STACKS):
            folder = self.photos / f'stack{number}'
            folder.mkdir()
            for level in range(3):
                write(folder / f'{level}.png', np.round(plane(2 * level)).astype(np.uint8))
        (self.photos / 'stack1/1.png').write_bytes(b'')
        (self.photos / 'notes.txt').write_text('not a stack')

    def arguments(self, *more):
        return [PROGRAM, '--batch', self.photos, '-o', self.results, *more]

    def run_batch(self, *more):
        return subprocess.run(self.arguments(*more), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=SECONDS * 3)

    def assert_all_but_the_broken_one(self, status, output):
        self.assertEqual(status, 1, output)
        lines = output.strip().splitlines()
        self.assertRegex(lines[-1], f'^{STACKS - 1} stacks done, 1 failed, ', output)
        broken = [line for line in lines if 'FAILED' in line]
        self.assertEqual(len(broken), 1)
        self.assertRegex(broken[0], r'^stack1 +FAILED: .*stack1/1\.png cannot be read: ')
        names = {f'stack{number}{ending}' for number in range(STACKS) if number != 1 for ending in ('.tif', '-depth.tif')}
        self.assertEqual({path.name for path in self.results.iterdir()}, names)

    def test_one_that_fails_does_not_end_it_and_what_is_there_is_kept(self):
        finished = self.run_batch()
        self.assert_all_but_the_broken_one(finished.returncode, finished.stdout)
        kept = (self.results / 'stack0.tif').stat().st_mtime_ns
        (self.results / 'stack2.tif').unlink()
        finished = self.run_batch()
        self.assert_all_but_the_broken_one(finished.returncode, finished.stdout)
        self.assertIn(f'{STACKS - 2} of {STACKS} stacks are there already', finished.stderr)
        self.assertEqual((self.results / 'stack0.tif').stat().st_mtime_ns, kept)
        shutil.copy(self.photos / 'stack0/1.png', self.photos / 'stack1/1.png')
        self.assertEqual(self.run_batch().returncode, 0)

    def test_a_worker_that_is_killed_loses_no_stack(self):
        self.skip_without_dask()
        process = subprocess.Popen(alone(self.arguments('--workers', '2')), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + SECONDS
        while time.monotonic() < end and process.poll() is None and not list(self.results.glob('*.tif')):
            time.sleep(0.05)
        while time.monotonic() < end and process.poll() is None:
            worker = busy_worker(process.pid)
            if worker:
                os.kill(worker, signal.SIGKILL)
                break
            time.sleep(0.01)
        else:
            self.fail('no worker was seen at work')
        output, errors = process.communicate(timeout=SECONDS * 3)
        self.assert_all_but_the_broken_one(process.returncode, output)
        told = [line.split(':')[0].strip() for line in errors.splitlines() if line.startswith('   stack')]
        self.assertEqual(sorted(told), sorted(f'stack{number}' for number in range(STACKS)), errors)

    def skip_without_dask(self):
        if os.getuid() != 0:
            self.skipTest('a network namespace takes root')
        if subprocess.run(['/usr/bin/python3', '-c', 'import distributed'], stderr=subprocess.DEVNULL).returncode:
            self.skipTest('python3-distributed is not installed')

    def test_a_cluster_that_is_there_is_used(self):
        self.skip_without_dask()
        cluster = ("dask-scheduler --host 127.0.0.1 --port 8786 --no-dashboard >/dev/null 2>&1 & "
                   "dask-worker tcp://127.0.0.1:8786 --nthreads 1 --no-dashboard >/dev/null 2>&1 & exec \"$@\"")
        command = ['unshare', '-n', 'sh', '-c', f'ip link set lo up; {cluster}', 'sh',
                   *self.arguments('--scheduler', 'tcp://127.0.0.1:8786')]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.photos,
                                   start_new_session=True)
        try:
            output, errors = process.communicate(timeout=SECONDS * 3)
        finally:  # the cluster is of its session, and does not end by itself
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        self.assert_all_but_the_broken_one(process.returncode, output or errors)

    def test_an_interrupt_ends_it_and_leaves_whole_files(self):
        process = subprocess.Popen(self.arguments(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + SECONDS
        while time.monotonic() < end and not list(self.results.glob('stack0.tif')):
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=SECONDS)
        self.assertEqual(process.returncode, 130)
        self.assertRegex(errors.splitlines()[-1], 'stopped; what is done stays, and the same command goes on$')
        time.sleep(0.5)
        self.assertFalse([path for path in self.results.iterdir() if 'unfinished' in path.name])
        finished = self.run_batch()
        self.assert_all_but_the_broken_one(finished.returncode, finished.stdout)
        self.assertIn('there already', finished.stderr)

    def test_what_is_wrong_is_told(self):
        for status, words, arguments in (
                (2, 'one stack', self.arguments('--depth', 'z.tif')), (2, 'a folder for the results', [PROGRAM, '--batch', self.photos]),
                (2, 'no number of workers', self.arguments('--workers', '0')), (2, '--batch', [PROGRAM, self.photos, '-o', 'a.png', '--workers', '2']),
                (1, 'holds no folders', [PROGRAM, '--batch', self.photos / 'stack0', '-o', self.results])):
            finished = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=SECONDS)
            self.assertEqual(finished.returncode, status)
            self.assertIn(words, finished.stderr.strip().splitlines()[-1])


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
