#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_installed.py SOURCE_ROOT BUILD_ROOT: installs into a temporary folder and uses what is there, as an application would."""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = (pathlib.Path(path) for path in sys.argv[1:3])
SECONDS = 120


def run(*command, **options):
    finished = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=SECONDS, **options)
    if finished.returncode != 0:
        raise AssertionError(f'{command} ended with status {finished.returncode}\n{finished.stdout}')
    return finished.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        root = pathlib.Path(cls.folder.name)
        run('meson', 'install', '-C', BUILD, '--no-rebuild', '--quiet', '--destdir', root)
        pkg_config = next(root.rglob('gstreamer-dff-1.0.pc'))
        text = pkg_config.read_text()
        prefix = root / re.search('^prefix=/(.*)$', text, re.MULTILINE)[1]
        pkg_config.write_text(re.sub('^prefix=.*$', f'prefix={prefix}', text, flags=re.MULTILINE))
        library = pkg_config.parent.parent
        cls.environment = {name: value for name, value in os.environ.items() if not name.startswith('GST_')}
        cls.environment.update(
            PKG_CONFIG_PATH=str(pkg_config.parent), LD_LIBRARY_PATH=str(library),
            GI_TYPELIB_PATH=str(library / 'girepository-1.0'), GST_PLUGIN_PATH=str(library / 'gstreamer-1.0'),
            GST_REGISTRY=str(root / 'registry.bin'), POCL_CACHE_DIR=os.environ.get('POCL_CACHE_DIR', str(root / 'pocl')))

    def assert_ten_distances(self, output, unit):
        lines = re.findall(rf'^sweep \d+: ([0-9.]+) {unit}$', output, re.MULTILINE)
        self.assertEqual(len(lines), 10, output)
        self.assertTrue(all(0.2 <= float(value) <= 5 for value in lines), output)

    def assert_fails_saying(self, words, *command, **environment):
        finished = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  timeout=20, env={**self.environment, **environment})
        self.assertEqual(finished.returncode, 1, finished.stdout + finished.stderr)
        self.assertIn(words, finished.stderr)

    def assert_bad_sources_end_it(self, *command):
        """One fails when it is made, one when it starts, one when it runs."""
        self.assert_fails_saying('nosuchelement', *command, 'nosuchelement')
        self.assert_fails_saying('/no/such/file', *command, 'filesrc location=/no/such/file ! gdpdepay')
        self.assert_fails_saying('stream', *command, 'filesrc location=/dev/zero num-buffers=9 ! gdpdepay')
        self.assert_fails_saying('OpenCL', *command, OCL_ICD_VENDORS='/nonexistent')

    def test_c_program_reads_the_depth(self):
        flags = run('pkg-config', '--cflags', '--libs', 'gstreamer-dff-1.0', 'gstreamer-app-1.0', env=self.environment)
        program = pathlib.Path(self.folder.name, 'read_depth')
        run('cc', '-Wall', '-Werror', SOURCE / 'pipelines/embed/read_depth.c', '-o', program, *shlex.split(flags),
            env=self.environment)
        self.assert_ten_distances(run(program, env=self.environment), 'dioptres')
        self.assert_fails_saying('OpenCL', program, OCL_ICD_VENDORS='/nonexistent')

    def test_python_program_reads_the_depth(self):
        program = sys.executable, SOURCE / 'pipelines/embed/read_depth.py'
        self.assert_ten_distances(run(*program, env=self.environment), 'm')
        self.assert_fails_saying('OpenCL', *program, OCL_ICD_VENDORS='/nonexistent')

    def assert_two_sources(self, output):
        lines = re.findall(r'^sweep (\d+) of (\S+) to (\S+) dioptres: (\d+) mm, colour \d+ \d+ \d+$', output, re.MULTILINE)
        self.assertEqual([line[:3] for line in lines],
                         [(str(k), '5', '0.5') for k in range(5)] + [(str(k), '4', '0.25') for k in range(2)], output)
        self.assertTrue(all(200 <= int(line[3]) <= 4000 for line in lines), output)

    TWO_SOURCES = ('lenssweeptestsrc num-buffers=30 near=5 far=0.5 ! video/x-raw,width=160,height=120',
                   'lenssweeptestsrc num-buffers=12 near=4 far=0.25 ! video/x-raw,width=96,height=96')

    def test_cpp_program_has_the_camera_in_one_element(self):
        flags = run('pkg-config', '--cflags', '--libs', 'gstreamer-dff-1.0', 'gstreamer-app-1.0', env=self.environment)
        program = pathlib.Path(self.folder.name, 'depth_camera')
        run('c++', '-std=c++20', '-Wall', '-Werror', SOURCE / 'pipelines/embed/depth_camera.cpp', '-o', program,
            *shlex.split(flags), env=self.environment)
        self.assert_two_sources(run(program, *self.TWO_SOURCES, env=self.environment))
        self.assert_bad_sources_end_it(program)

    def test_python_program_has_the_camera_in_one_element(self):
        program = sys.executable, SOURCE / 'pipelines/embed/depth_camera.py'
        self.assert_two_sources(run(*program, *self.TWO_SOURCES, env=self.environment))
        self.assert_bad_sources_end_it(*program)

    def test_dff_stack_finds_what_it_needs(self):
        program = next(pathlib.Path(self.folder.name).rglob('bin/dff-stack'))
        self.assertIn('EXIT STATUS', run(program, '--help', env=self.environment))
        photos = pathlib.Path(self.folder.name, 'photos')
        photos.mkdir()
        run('gst-launch-1.0', 'lenssweeptestsrc', 'num-buffers=4', 'planes=4', '!', 'videoconvert', '!', 'pngenc', '!', 'multifilesink',
            f'location={photos}/%d.png', env=self.environment)
        run(program, photos, '-o', photos.parent / 'sharp.jpg', env=self.environment)
        self.assertTrue((photos.parent / 'sharp.jpg').read_bytes().startswith(b'\xff\xd8'))

    def test_every_program_has_a_page_that_names_its_options(self):
        root = pathlib.Path(self.folder.name)
        for program in (path for folder in root.rglob('bin') for path in folder.iterdir()):
            with self.subTest(program=program.name):
                page = next(root.rglob(f'man/man1/{program.name}.1'), None)
                self.assertIsNotNone(page, 'add it beside the program, and an install_man')
                named = set(re.findall(r'--[a-z-]*[a-z]', page.read_text().replace('\\-', '-')))
                told = set(re.findall(r'(?<![\w-])--[a-z-]*[a-z]', run(program, '--help', env=self.environment)))
                self.assertEqual(told - named, set(), f'options that {page.name} does not name')
                self.assertEqual(named - told, set(), f'options of {page.name} that are none')

    def test_programs_that_name_their_interpreter_can_be_run(self):
        for folder in ('pipelines', 'docs'):
            for path in (SOURCE / folder).rglob('*'):
                if path.is_file() and path.read_bytes().startswith(b'#!'):
                    self.assertTrue(os.access(path, os.X_OK), path)

    def test_every_plug_in_is_installed_and_loads(self):
        environment = {name: value for name, value in self.environment.items() if name != 'LD_LIBRARY_PATH'}
        run(next(pathlib.Path(self.folder.name).rglob('bin/dff-rtsp-server')), '--help', env=environment)
        for element in ('lenssweeptestsrc', 'focalstackmux', 'dffdepth', 'aifcompose', 'dffcamerabin', 'depthcolorize', 'dffmetapay', 'depthexrenc',
                        'lightfieldcompose'):
            run('gst-inspect-1.0', element, env=environment)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
