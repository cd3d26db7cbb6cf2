#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_stack.py SOURCE_ROOT: dff-stack as a user runs it, from folders to files."""
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest

import numpy as np
import OpenImageIO as oiio

import net
from slope import HEIGHT, PLANES, WIDTH, blurred, plane, sharp
from sweeps import SECONDS, Folders, write

SOURCE = pathlib.Path(sys.argv[1])
PROGRAM = SOURCE / 'pipelines/stack/dff-stack'


ISO, FOCAL_LENGTH_35MM, LATITUDE_REF = 0x8827, 0xa405, 1
POINTERS = (0x8769, 0x8825)


def exif_of(path):
    """Some values of the tables of EXIF and GPS in a TIFF, JPEG or PNG file."""
    data = path.read_bytes()
    start = {'.jpg': data.find(b'Exif\0\0') + 6, '.png': data.find(b'eXIf') + 4, '.tif': 0}[path.suffix]
    data, found = data[start:], {}
    assert data[:4] == b'II*\0'
    tables = [struct.unpack_from('<I', data, 4)[0]]
    for at in tables:
        before = -1
        for k in range(struct.unpack_from('<H', data, at)[0]):
            tag, kind, count, field = struct.unpack_from('<HHI4s', data, at + 2 + 12 * k)
            assert before < tag or path.suffix != '.tif', f'{tag} after {before}'
            before = tag
            if tag in POINTERS:
                tables.append(struct.unpack('<I', field)[0])
            if at != tables[0] and tag in (ISO, FOCAL_LENGTH_35MM, LATITUDE_REF):
                found[tag] = field
    return found


def predictor(path):
    """What a TIFF file tells of the differences between neighbours that stand in it for values: 1 is none."""
    data = path.read_bytes()
    at = struct.unpack_from('<I', data, 4)[0]
    entries = (struct.unpack_from('<HHIH', data, at + 2 + 12 * k) for k in range(struct.unpack_from('<H', data, at)[0]))
    return {tag: value for tag, _, _, value in entries}.get(317, 1)


def read(path):
    image = oiio.ImageInput.open(str(path))
    assert image, oiio.geterror()
    spec = oiio.ImageSpec(image.spec())
    pixels = image.read_image(0, 0, 0, spec.nchannels, oiio.UNKNOWN)
    image.close()
    return spec, pixels


class Program(Folders):
    def setUp(self):
        super().setUp()
        self.out = self.photos.parent

    def run_program(self, *arguments, **environment):
        return subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              timeout=SECONDS, env={**os.environ, **environment})

    def stack(self, *arguments):
        finished = self.run_program(*arguments)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        return finished

    def assert_fails(self, status, phrase, *arguments, **environment):
        finished = self.run_program(*arguments, **environment)
        self.assertEqual(finished.returncode, status, finished.stderr)
        self.assertIn(phrase, finished.stderr.strip().splitlines()[-1])
        self.assertNotIn('Traceback', finished.stderr)
        return finished

    def write_sweep(self, ending='png', factor=1, kind=np.uint8):
        for number in range(PLANES):
            write(self.photos / f'p{number}.{ending}', np.round(plane(number) * factor).astype(kind))

    def assert_slope(self, depth, slack=0.6):
        slope = np.linspace(0, PLANES - 1, WIDTH)
        self.assertLess(np.nanmedian(np.abs(depth[16:-16, 16:-16] - slope[None, 16:-16])), slack)


class Results(Program):
    def test_all_of_them(self):
        self.write_sweep()
        names = {'output': 'all.tif', 'depth': 'z.tif', 'depth-code': 'z.png', 'depth-colours': 'c.jpg', 'index': 'i.png',
                 'confidence': 'sure.png', 'cloud': 'p.ply', 'save-alignment': 'a.json', 'video': 'v.webm', 'mesh': 'm.glb', 'report': 'r.html'}
        finished = self.stack(self.photos, *(word for name, file in names.items() for word in (f'--{name}', self.out / file)))
        self.assertEqual([line.split()[1] for line in finished.stdout.splitlines()], [f'p{number}.png' for number in range(PLANES)])
        self.assertEqual(sorted(path.name for path in self.out.iterdir()), sorted([*names.values(), 'photos']))
        spec, pixels = read(self.out / 'all.tif')
        self.assertLess(np.abs(pixels[16:-16, 16:-16].astype(float) - sharp()[16:-16, 16:-16]).mean(), 4)
        self.assertIn('dff-stack', spec.get_string_attribute('Software'))
        self.assertIn('6 pictures', spec.get_string_attribute('ImageDescription'))
        _, depth = read(self.out / 'z.tif')
        self.assertEqual(depth.dtype, np.float32)
        self.assert_slope(depth[:, :, 0])
        _, code = read(self.out / 'z.png')
        self.assertEqual(code.dtype, np.uint16)
        self.assert_slope((code[:, :, 0] - 1.0) * (PLANES - 1) / 65534)
        _, index = read(self.out / 'i.png')
        np.testing.assert_array_equal(index[:, :, 0], np.nan_to_num(np.round(depth[:, :, 0]) + 1))
        header, _, vertices = (self.out / 'p.ply').read_bytes().partition(b'end_header\n')
        self.assertIn(f'element vertex {len(vertices) // 15}'.encode(), header)
        self.assert_mesh((self.out / 'm.glb').read_bytes())
        page = (self.out / 'r.html').read_text()
        self.assertEqual(page.count('<img '), 3 + PLANES)
        self.assertNotIn('src="http', page)
        self.assertIn('6 p5.png', page)
        self.assertTrue((self.out / 'v.webm').read_bytes().startswith(b'\x1aE\xdf\xa3'))

    def test_the_index_counts_as_the_list_does_where_a_picture_is_left_out(self):
        self.write_sweep()
        shutil.copy(self.photos / 'p2.png', self.photos / 'p2-copy.png')
        finished = self.stack(self.photos, '--index', self.out / 'i.png')
        listed = {int(line.split()[0]): line.split()[1] for line in finished.stdout.splitlines() if line.split()[0].isdecimal()}
        without = [number for number, name in listed.items() if name not in ('p2.png', 'p2-copy.png')]
        _, index = read(self.out / 'i.png')
        self.assertEqual([listed[number] for number in np.unique(index) if number in without], ['p0.png', 'p1.png', 'p3.png', 'p4.png', 'p5.png'])
        self.assertEqual(len(np.unique(index)), PLANES)
        self.assertEqual(listed[int(np.median(index[:, -3:]))], 'p5.png')

    def assert_mesh(self, data):
        """A surface whose left is nearest to the viewer."""
        magic, version, length, json_length = struct.unpack('<4sIII', data[:16])
        self.assertEqual((magic, version, length), (b'glTF', 2, len(data)))
        facts, binary = json.loads(data[20:20 + json_length]), data[28 + json_length:]
        self.assertEqual(facts['buffers'][0]['byteLength'], len(binary))
        arrays = []
        for accessor in facts['accessors']:
            view = facts['bufferViews'][accessor['bufferView']]
            kind = {5126: '<f4', 5125: '<u4'}[accessor['componentType']]
            part = np.frombuffer(binary[view['byteOffset']:view['byteOffset'] + view['byteLength']], kind)
            arrays.append(part.reshape(accessor['count'], -1))
        vertices, places, faces = arrays
        self.assertEqual(len(vertices), len(places))
        self.assertLess(faces.max(), len(vertices))
        left, right = (np.median(vertices[part][:, 2]) for part in (places[:, 0] < 0.2, places[:, 0] > 0.8))
        self.assertGreater(left, right + 0.1)
        image = facts['bufferViews'][facts['images'][0]['bufferView']]
        self.assertEqual(binary[image['byteOffset']:image['byteOffset'] + 2], b'\xff\xd8')

    def test_16_bits_of_grey_stay(self):
        ramp = np.linspace(10000, 50000, WIDTH)
        for number in range(PLANES):
            tone = ramp[None] + plane(number)[:, :, 0] * 8
            write(self.photos / f'{number}.tif', np.round(tone)[:, :, None].astype(np.uint16))
        self.stack(self.photos, '-o', self.out / 'a.png', '--align', 'off', '--even', 'off')
        spec, pixels = read(self.out / 'a.png')
        self.assertEqual((spec.nchannels, pixels.dtype), (1, np.uint16))
        self.assertLess(np.abs(pixels[16:-16, 16:-16, 0] - (ramp[None] + sharp()[:, :, 0] * 8)[16:-16, 16:-16]).mean(), 40)
        self.assertGreater(len(np.unique(pixels)), 4096)

    def test_16_bits_a_colour_stay(self):
        """As far as the elements take them."""
        ramp = np.linspace(10000, 50000, WIDTH * HEIGHT).reshape(HEIGHT, WIDTH, 1) * (1, 0.9, 0.5)
        for number in range(PLANES):
            write(self.photos / f'{number}.tif', np.round(ramp + plane(number) * 8).astype(np.uint16))
        finished = self.stack(self.photos, '-o', self.out / 'a.tif', '--align', 'off', '--even', 'off')
        spec, pixels = read(self.out / 'a.tif')
        scale, slack = (257, 1.2) if 'is rounded' in finished.stderr else (1, 40)
        self.assertEqual(pixels.dtype, np.uint8 if scale > 1 else np.uint16)
        self.assertLess(np.abs(pixels.astype(float) - (ramp + sharp() * 8) / scale)[16:-16, 16:-16].mean(), slack)
        if scale == 1:
            self.assertGreater(len(np.unique(pixels[:, :, 0])), 4096)

    def test_a_plain_reader_takes_its_tiff(self):
        """ImageJ takes the differences of deflated 16-bit and float pictures for values, and tifffile alone refuses the latter."""
        self.write_sweep('tif', 200, np.uint16)
        self.stack(self.photos, '-o', self.out / 'a.tif', '--depth', self.out / 'z.tif', '--align', 'off')
        self.assertEqual([predictor(self.out / name) for name in ('a.tif', 'z.tif')], [1, 1])

    def test_exif_and_profile_are_kept(self):
        profile = struct.pack('>I4xI4s4s4s', 256, 0x04000000, b'mntr', b'RGB ', b'XYZ ').ljust(36, b'\0') + b'acsp'
        profile = (profile.ljust(68, b'\0') + bytes.fromhex('0000f6d6000100000000d32d')).ljust(132, b'\0') + b'mine' * 31
        segment = b'ICC_PROFILE\0\1\1' + profile
        for number in range(2):
            spec = oiio.ImageSpec(WIDTH, HEIGHT, 3, oiio.UINT8)
            spec['ExposureTime'], spec['Make'], spec['Orientation'] = 0.01, 'Maker', 3
            spec['Exif:PhotographicSensitivity'], spec['Exif:LensModel'], spec['Artist'] = 400, 'Macro 100', 'Jürgen 山'
            spec['GPS:LatitudeRef'], spec['Exif:FocalLengthIn35mmFilm'] = 'N', 150
            output = oiio.ImageOutput.create('x.jpg')
            path = self.photos / f'{number}ü.jpg'
            turned = np.ascontiguousarray(np.round(plane(3 * number)).astype(np.uint8)[::-1, ::-1])
            assert output.open(str(path), spec) and output.write_image(turned) and output.close()
            path.write_bytes(b'\xff\xd8\xff\xe2' + struct.pack('>H', len(segment) + 2) + segment + path.read_bytes()[2:])
        for name in ('a.tif', 'a.jpg', 'a.png', 'a.exr'):
            self.stack(self.photos, '-o', self.out / name)
            spec, pixels = read(self.out / name)
            self.assertAlmostEqual(spec.get_float_attribute('ExposureTime'), 0.01, places=4)
            self.assertEqual((spec.get_string_attribute('Make'), spec.get_int_attribute('Orientation', 1)), ('Maker', 1))
            self.assertEqual((spec.get_string_attribute('Artist'), spec.get_string_attribute('Exif:LensModel')), ('Jürgen 山', 'Macro 100'))
            self.assertIn('0ü.jpg', spec.get_string_attribute('ImageDescription'))
            if name != 'a.exr':
                self.assertEqual(exif_of(self.out / name), {ISO: b'\x90\1\0\0', FOCAL_LENGTH_35MM: b'\x96\0\0\0', LATITUDE_REF: b'N\0\0\0'})
            if name == 'a.png':  # texts without a language have letters of Latin-1
                self.assertIn(b'iTXtAuthor\0\0\0\0\0' + 'Jürgen 山'.encode(), (self.out / name).read_bytes())
            else:
                has_profile = profile in (self.out / name).read_bytes()
                self.assertEqual(has_profile, name != 'a.exr')

    def test_linear_light_comes_back(self):
        for number in range(PLANES):
            write(self.photos / f'{number}.exr', (plane(number) / 64).astype(np.float32))
        self.stack(self.photos, '-o', self.out / 'a.exr', '--even', 'off', '--align', 'off')
        spec, pixels = read(self.out / 'a.exr')
        self.assertEqual(spec.get_string_attribute('oiio:ColorSpace'), 'Linear')
        self.assertLess(np.abs(pixels.astype(float) - sharp() / 64)[16:-16, 16:-16].mean(), 0.06)

    def test_numbers_that_count_are_not_all_white(self):
        """As of photons: what 1 is says nothing of them, and half floats end at 65,504."""
        for number in range(PLANES):
            write(self.photos / f'{number}.tif', (plane(number)[:, :, :1] * 400).astype(np.float32))
        self.stack(self.photos, '-o', self.out / 'a.tif', '--mesh', self.out / 'm.glb', '--even', 'off', '--align', 'off')
        _, pixels = read(self.out / 'a.tif')
        self.assertLess((pixels == 65535).mean(), 0.01)
        shown = np.where(pixels <= 0.04045 * 65535, pixels / 65535 / 12.92, ((pixels / 65535 + 0.055) / 1.055) ** 2.4)[16:-16, 16:-16, 0]
        truth = sharp()[16:-16, 16:-16, 0]
        self.assertLess(np.abs(shown / np.median(shown) - truth / np.median(truth)).mean(), 0.06)
        self.stack(self.photos, '-o', self.out / 'a.exr', '--even', 'off', '--align', 'off')
        _, pixels = read(self.out / 'a.exr')
        self.assertLess(np.abs(pixels[16:-16, 16:-16, 0] / 400 - truth).mean(), 4)

    def test_an_alignment_is_used_again(self):
        self.write_sweep()
        shifted = np.round(plane(2, np.roll(sharp(), 5, 1))).astype(np.uint8)
        write(self.photos / 'p2.png', shifted)
        self.stack(self.photos, '-o', self.out / 'a.tif', '--save-alignment', self.out / 'a.json')
        self.stack(self.photos, '-o', self.out / 'b.tif', '--use-alignment', self.out / 'a.json')
        np.testing.assert_array_equal(read(self.out / 'a.tif')[1], read(self.out / 'b.tif')[1])
        (self.photos / 'p5.png').unlink()
        self.assert_fails(1, '6 pictures, and there are 5', self.photos, '-o', self.out / 'b.tif', '--use-alignment', self.out / 'a.json')

    def test_heights_by_the_step(self):
        self.write_sweep()
        self.stack(self.photos, '--depth', self.out / 'z.exr', '--step', '2.5')
        self.assert_slope(read(self.out / 'z.exr')[1][:, :, 0] / 2.5)

    def test_far_first_turns_the_depth(self):
        self.write_sweep()
        self.stack(self.photos, '--depth', self.out / 'z.tif', '--far-first')
        self.assert_slope(PLANES - 1 - read(self.out / 'z.tif')[1][:, :, 0])

    def test_a_wrong_order_is_told_and_stands_in_the_report(self):
        self.write_sweep()
        (self.photos / 'p3.png').rename(self.photos / 'p9.png')
        words = 'Out of order, it seems: p9.png.'
        finished = self.stack(self.photos, '--report', self.out / 'r.html')
        self.assertIn(words, finished.stderr)
        self.assertIn(words, (self.out / 'r.html').read_text())
        (self.photos / 'p9.png').rename(self.photos / 'p3.png')
        self.assertNotIn('order', self.stack(self.photos, '-o', self.out / 'a.png').stderr)

    def test_a_preview_is_a_quarter(self):
        for number in range(PLANES):
            write(self.photos / f'{number}.png', np.round(np.kron(plane(number), np.ones((4, 4, 1)))).astype(np.uint8))
        files = {'-o': 'a.png', '--depth': 'z.tif', '--cloud': 'p.ply'}
        self.stack(self.photos, *(word for name, file in files.items() for word in (name, self.out / file)),
                   '--preview', '--step', 20, '--pixel-size', 2.5)
        spec, pixels = read(self.out / 'a.png')
        self.assertEqual((spec.width, spec.height), (WIDTH, HEIGHT))
        spec, _ = read(self.out / 'z.tif')
        self.assertEqual((spec.get_float_attribute('XResolution'), spec.get_string_attribute('ResolutionUnit')), (1000, 'cm'))
        vertices = (self.out / 'p.ply').read_bytes().partition(b'end_header\n')[2]
        across = np.frombuffer(vertices, [('x', '<f4'), ('others', 'V11')])['x']
        self.assertEqual(across.max() - across.min(), 10 * (WIDTH - 1))


class SeenThrough(Program):
    def test_what_is_preferred_is_kept(self):
        pictures, ground = net.sweep()
        for number, pixels in enumerate(pictures):
            write(self.photos / f'{number}.png', pixels)
        threads = net.threads()[:, :, 0] > 0
        inner = np.zeros_like(threads)
        inner[24:-24, 24:-24] = True
        beside = inner & (sum(np.roll(threads, shift, axis) for axis in (0, 1) for shift in range(-10, 11)) == 0)
        for preferred, plane, share, tones in (('near', net.NEAR, 0.75, np.array(net.TONE)), ('far', net.FAR, 0.9, ground[threads & inner])):
            self.stack(self.photos, '-o', self.out / 'a.png', '--depth', self.out / 'z.tif', '--align', 'off', '--even', 'off',
                       '--prefer', preferred)
            depth, picture = read(self.out / 'z.tif')[1][:, :, 0], read(self.out / 'a.png')[1].astype(float)
            with self.subTest(preferred):
                self.assertGreater(np.mean(np.abs(depth - plane)[threads & inner] < 1), share)
                self.assertGreater(np.mean(np.abs(depth - net.FAR)[beside] < 1), 0.97)
                self.assertLess(np.abs(picture[threads & inner] - tones).mean(), 18)
                self.assertLess(np.abs(picture - ground)[beside].mean(), 4)


class Failing(Program):
    def test_nothing_is_left_of_what_fails(self):
        self.write_sweep()
        (self.photos / 'p3.png').write_bytes((self.photos / 'p3.png').read_bytes()[:-2000])
        (self.out / 'a.png').write_text('what was there')
        self.assert_fails(1, 'p3.png cannot be read: ', self.photos, '-o', self.out / 'a.png', '--depth', self.out / 'z.png')
        self.assertEqual(sorted(path.name for path in self.out.iterdir()), ['a.png', 'photos'])
        self.assertEqual((self.out / 'a.png').read_text(), 'what was there')

    def test_what_is_wrong_is_told(self):
        self.write_sweep()
        out = self.out / 'a.png'
        self.assert_fails(2, '-o result.tif', self.photos)
        self.assert_fails(2, 'name the pictures', '-o', out)
        self.assert_fails(2, 'must end in', self.photos, '-o', self.out / 'a.gif')
        self.assert_fails(2, 'the same name', self.photos, '-o', out, '--depth', out)
        self.assert_fails(2, '6G', self.photos, '-o', out, '--memory', 'much')
        for place, words in ((self.out / 'nowhere/a.png', 'no folder'), (self.photos / 'sub.tif', 'it is a folder')):
            (self.photos / 'sub.tif').mkdir(exist_ok=True)
            finished = self.assert_fails(1, words, self.photos, '-o', out, '--depth', place)
            self.assertNotIn('Reading', finished.stderr)  # nobody waits for what cannot be written
        (self.photos / 'sub.tif').rmdir()
        self.assert_fails(1, 'no alignment', self.photos, '-o', out, '--use-alignment', self.photos / 'p1.png')
        self.assert_fails(1, 'OpenCL', self.photos, '-o', out, OCL_ICD_VENDORS='/nonexistent')
        self.assertFalse(out.exists())

    def test_a_full_disk_leaves_nothing(self):
        self.write_sweep()
        disk = self.out / 'disk'
        disk.mkdir()
        small = ['unshare', '--user', '--map-root-user', '--mount', 'sh', '-c',
                 'mount -t tmpfs -o size=16k tmpfs "$0" && echo before >"$0/a.png" && "$@"; status=$?; ls -A "$0"; cat "$0/a.png"; exit $status']
        for option, name in (('-o', 'a.tif'), ('-o', 'a.png'), ('-o', 'a.jpg'), ('-o', 'a.exr'), ('--cloud', 'a.ply'), ('--video', 'a.webm')):
            finished = subprocess.run([*small, disk, PROGRAM, self.photos, option, disk / name, '--quiet'], stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, text=True, timeout=SECONDS, check=False)
            with self.subTest(name):
                self.assertEqual(finished.returncode, 1, finished.stderr)
                self.assertIn(f'{name} cannot be written: ', finished.stderr.strip().splitlines()[-1])
                self.assertEqual(finished.stdout, 'a.png\nbefore\n')

    def test_names_of_any_bytes_stay_on_their_line(self):
        self.write_sweep()
        (self.photos / 'p1.png').rename(self.photos / 'p1\n\x1b[2J%s.png')
        finished = self.stack(self.photos, '-o', self.out / 'a\nb.png')
        self.assertEqual(finished.stdout.splitlines()[1].split()[1], r'p1\n\x1b[2J%s.png')
        self.assertTrue((self.out / 'a\nb.png').exists())
        for name, words in ((b'p2\n.png', r'p2\n.png cannot be read'), (b'a\xff.png', r'a\udcff.png cannot be read: its name is not UTF-8')):
            bad = pathlib.Path(os.fsdecode(os.fsencode(self.photos) + b'/' + name))
            bad.write_bytes(b'no picture')
            self.assert_fails(1, words, self.photos, '-o', self.out / 'a.png')
            bad.unlink()

    def test_no_picture_is_lost_to_a_result(self):
        self.write_sweep()
        before = (self.photos / 'p3.png').read_bytes()
        (self.out / 'link.png').symlink_to(self.photos / 'p3.png')
        for place in (self.photos / 'p3.png', self.out / 'link.png'):
            self.assert_fails(1, f'{place} is one of the pictures', self.photos, '-o', self.out / 'a.tif', '--depth-code', place)
        self.assertEqual((self.photos / 'p3.png').read_bytes(), before)

    def test_pictures_of_other_things_are_left_out(self):
        self.write_sweep()
        other = np.random.default_rng(8).integers(0, 256, (HEIGHT, WIDTH, 3)).astype(float)
        write(self.photos / 'p2b.png', np.round(blurred(other, 1)).astype(np.uint8))
        finished = self.stack(self.photos, '-o', self.out / 'a.png')
        self.assertRegex(finished.stderr, r'Left out.*: p2b\.png')

    def test_an_interrupt_leaves_nothing(self):
        self.write_sweep()
        for after in (0.6, 1.5):
            process = subprocess.Popen([PROGRAM, self.photos, '-o', self.out / 'a.png'], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.PIPE, text=True)
            time.sleep(after)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=SECONDS)
            if process.returncode == 0:  # it was done before
                (self.out / 'a.png').unlink()
                continue
            self.assertIn(process.returncode, (130, -signal.SIGINT), errors)
            self.assertEqual([path.name for path in self.out.iterdir()], ['photos'])

    def test_an_interrupt_of_what_is_done_comes_too_late(self):
        self.write_sweep()
        result = self.out / 'a.png'
        with subprocess.Popen([PROGRAM, self.photos, '-o', result], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None:
                if result.exists():
                    process.send_signal(signal.SIGINT)
                time.sleep(0.001)
            self.assertEqual(process.returncode, 0, process.stderr.read())
        self.assertTrue(result.exists())

    def test_help_is_a_manual(self):
        text = self.stack('--help').stdout
        for word in ('ORDER', 'RESULTS', 'MEMORY', 'EXAMPLES', 'EXIT STATUS', '--far-first', '--preview'):
            self.assertIn(word, text)


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
