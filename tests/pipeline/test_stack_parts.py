#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_stack_parts.py SOURCE_ROOT: how dff-stack cuts what is too large and joins the parts, and how warps are chained."""
import itertools
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np
import OpenImageIO as oiio

from slope import MANY, many_planes

sys.path.insert(0, str(pathlib.Path(sys.argv[1], 'pipelines/stack')))
from dff_stack import Unusable, alignment, engine, joining, memory, ome, pictures, results, slabs, solve  # noqa: E402
from dff_stack.encoding import Encoding  # noqa: E402
from dff_stack.progress import Progress  # noqa: E402

RGB = Encoding('RGB', 3, 'u1', False)
GIB = 2 ** 30


class Plans(unittest.TestCase):
    def test_slabs_share_planes_and_leave_none_out(self):
        for count in (2, 9, 16, 17, 64, 65, 300, 1000):
            for size in (3, 4, 8, 16, 64):
                spans = slabs.slabs_of(count, size)
                self.assertEqual((spans[0][0], spans[-1][1]), (0, count))
                self.assertTrue(all(2 <= last - first <= max(size, 2) for first, last in spans))
                self.assertTrue(all(before[1] - after[0] >= min(slabs.OVERLAP, size // 2) for before, after in zip(spans, spans[1:])), (count, size))

    def test_what_fits_is_computed_at_once(self):
        plan = slabs.plan(30, 1920, 1080, RGB, 4 * GIB, 10, 8192)
        self.assertEqual((plan.slabs, len(plan.tiles)), ([(0, 30)], 1))

    def test_300_pictures_of_24_megapixels_in_6_gib(self):
        plan = slabs.plan(300, 6000, 4000, RGB, 6 * GIB, 100, 8192)
        self.assertEqual(len(plan.tiles), 1)
        self.assertGreaterEqual(min(last - first for first, last in plan.slabs), slabs.FEWEST_PLANES)

    def test_large_pictures_are_tiles_that_overlap(self):
        for width, height in ((8256, 5504), (9504, 6336), (20000, 20000)):
            plan = slabs.plan(20, width, height, RGB, 64 * GIB, 300, 8192)
            self.assertTrue(all(max(tile.size) <= 8192 for tile in plan.tiles))
            covered = np.zeros((height // 8, width // 8), int)
            for tile in plan.tiles:
                covered[tile.y0 // 8:-(-tile.y1 // 8), tile.x0 // 8:-(-tile.x1 // 8)] += 1
            self.assertTrue(covered.all())
            self.assertGreaterEqual(plan.margin, 300 + slabs.MARGIN)

    def test_little_memory_takes_small_slabs(self):
        for memory_gib in (1, 1.3, 1.4, 1.5, 1.7, 2, 3):
            plan = slabs.plan(30, 3000, 2000, RGB, memory_gib * GIB, 20, 8192)
            self.assertTrue(all(last - first >= slabs.FEWEST_AT_ALL for first, last in plan.slabs))

    def test_too_little_memory_is_told(self):
        with self.assertRaisesRegex(Unusable, '0.5 GiB .* 6000x4000'):
            slabs.plan(300, 6000, 4000, RGB, 0.5 * GIB, 100, 8192)

    def test_memory_is_what_the_group_may_have(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / 'meminfo').write_text('MemTotal: 9 kB\nMemAvailable:    4000000 kB\n')
            self.assertEqual(memory.free_bytes(folder / 'meminfo', folder), 4000000 * 1024)
            (folder / 'memory.max').write_text('max\n')
            self.assertEqual(memory.free_bytes(folder / 'meminfo', folder), 4000000 * 1024)
            (folder / 'memory.max').write_text('2000000000\n')
            (folder / 'memory.current').write_text('500000000\n')
            self.assertEqual(memory.free_bytes(folder / 'meminfo', folder), 1500000000)
        self.assertEqual([memory.bytes_of(text) for text in ('6G', '1.5GiB', '800M', '2')], [6 * GIB, 1.5 * GIB, 800 * 2 ** 20, 2 * GIB])


class Joining(unittest.TestCase):
    def test_tiles_of_one_picture_give_it_again(self):
        width, height = 700, 500
        whole = engine.Solved(np.random.default_rng(1).integers(0, 256, (height, width, 3)).astype(np.uint8),
                              np.random.default_rng(2).random((height, width), np.float32),
                              np.full((height, width), 7, np.uint8))
        margin = 120
        pasted = joining.empty(RGB, (width, height))
        for tile in slabs.tiles_of(width, height, 2, 2, margin):
            there = slice(tile.y0, tile.y1), slice(tile.x0, tile.x1)
            part = engine.Solved(*(values[there].copy() for values in (whole.picture, whole.depth, whole.confidence)))
            for side, inner in ((np.s_[:, :20], tile.x0 > 0), (np.s_[:20], tile.y0 > 0)):
                if inner:  # what a tile knows of its borders is not to be used
                    part.picture[side], part.depth[side] = 0, np.nan
            joining.paste(pasted, part, tile, margin)
        np.testing.assert_array_equal(pasted.picture, whole.picture)
        np.testing.assert_allclose(pasted.depth, whole.depth, atol=1e-6)
        np.testing.assert_array_equal(pasted.confidence, whole.confidence)

    def test_two_surfaces_are_not_mixed(self):
        mixed = joining.mixed_depth(np.float32([2, 2, 2, np.nan, 2]), np.float32([2.5, 9, 9, 4, np.nan]), np.float32([0.5, 0.2, 0.7, 0.1, 0.9]))
        np.testing.assert_allclose(mixed, [2.25, 2, 9, 4, 2])

    def test_slabs_tell_of_their_own_planes(self):
        spans = [(0, 12), (8, 20), (16, 28)]
        truth = np.linspace(0, 27, 400, dtype=np.float32)[None]
        depths = np.stack([np.clip(truth, first, last - 1) for first, last in spans])
        centres = [(first + last - 1) / 2 for first, last in spans]
        upper = np.interp(truth, centres, range(3)).astype(np.float32)
        confidences = np.stack([np.full(truth.shape, number, np.uint8) for number in range(3)])
        joined, confidence = joining.joined_rows(depths, confidences, spans, upper)
        np.testing.assert_allclose(joined, truth, atol=0.005)
        self.assertEqual((confidence[0, 0], confidence[0, -1]), (0, 2))
        joined, _ = joining.joined_rows(depths, confidences, spans, upper * np.nan)
        self.assertTrue(np.isnan(joined).all())


class Warps(unittest.TestCase):
    def plane_warps(self, count):
        random = np.random.default_rng(5)
        return [np.array([[1 + 0.0002 * k, 1e-4 * x, 3 * x], [-1e-4 * x, 1 + 0.0002 * k, 2 * y], [0, 0, 1]])
                for k, (x, y) in enumerate(random.standard_normal((count, 2)))]

    def test_windows_are_chained(self):
        for count, most in itertools.product((2, 40, 64, 65, 200), (16, 18, 64)):
            truth = self.plane_warps(count)
            spans = alignment.windows(count, most)
            self.assertEqual((spans[0][0], spans[-1][1]), (0, count))
            self.assertLessEqual(max(last - first for first, last in spans), most)
            found = []
            for first, last in spans:
                middle = np.linalg.inv(truth[first + (last - first) // 2])
                found.append([{'matrix': truth[k] @ middle, 'trusted': True, 'blank': False} for k in range(first, last)])
            expected = [warp @ np.linalg.inv(truth[count // 2]) for warp in truth]
            np.testing.assert_allclose(alignment.chained(found, spans), expected, atol=1e-6)

    def test_memory_limits_what_is_matched_at_once(self):
        """In a process of its own, whose greatest memory can be asked for. Of 40 such pictures at once it is nearly 600 MB."""
        memory = 500e6
        code = (f'import sys; sys.path.insert(0, {sys.path[0]!r})\n'
                'import numpy as np\nfrom dff_stack import alignment, engine\nengine.start()\n'
                'scene = np.random.default_rng(1).integers(0, 256, (1330, 1990)).astype(np.uint8)\n'
                'lumas = [np.roll(scene, number % 3, 0) for number in range(40)]\n'
                f'window = alignment.window_for(lumas, {memory})\n'
                'found = alignment.estimate(lumas, 1, lambda some: engine.find_warps(some, print), window)\n'
                'assert all(found.trusted)\n'
                'most = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))\n'  # getrusage tells the parent's too
                'print(window, most.split()[1])')
        finished = subprocess.run([sys.executable, '-c', code], stdout=subprocess.PIPE, text=True, check=True, timeout=100)
        window, most_kib = map(int, finished.stdout.split())
        self.assertLess(most_kib * 1024, memory)
        self.assertEqual(alignment.window_for([np.zeros((1330, 1990), np.uint8)], 4 * GIB), alignment.MOST_IN_WINDOW)
        self.assertGreaterEqual(window, alignment.FEWEST_IN_WINDOW)

    def test_estimates_are_of_full_size(self):
        warp = np.array([[1, 0, 2.0], [0, 1, -1], [1e-5, 0, 1]])
        found = alignment.estimate([None] * 2, 4, lambda lumas: [{'matrix': warp, 'trusted': True, 'blank': False},
                                                                 {'matrix': np.eye(3), 'trusted': False, 'blank': True}])
        point = found.warps[0] @ [400, 0, 1]
        small = warp @ [100, 0, 1]
        np.testing.assert_allclose(point[:2] / point[2], 4 * small[:2] / small[2])
        self.assertEqual((found.trusted, found.blank), ([True, False], [False, True]))

    def test_a_stranger_in_the_middle_is_found(self):
        def find_warps(lumas):
            middle = lumas[len(lumas) // 2]
            return [{'matrix': np.eye(3), 'trusted': luma == middle, 'blank': False} for luma in lumas]
        found = alignment.estimate_most([1, 1, 1, 2, 1, 1, 1], 1, find_warps)
        self.assertEqual(alignment.misfits(found), {3})

    def test_warps_of_parts_and_how_far_they_go(self):
        warp = np.array([[1.02, 0, 5], [0, 1.02, 0], [0, 0, 1]])
        part = alignment.of_part(warp, (100, 50))
        there = part @ [7, 8, 1]
        whole = warp @ [107, 58, 1]
        np.testing.assert_allclose(there[:2], whole[:2] - [100, 50])
        self.assertAlmostEqual(alignment.farthest([np.eye(3), warp], 1000, 500), 15)

    def test_files_are_read_again_at_another_size(self):
        warps = self.plane_warps(3)
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name, 'a.json')
            path.write_text(alignment.text_of(warps, 1000, 500, ['a', 'b', 'c']))
            np.testing.assert_allclose(alignment.load(path, 1000, 500, 3).warps, warps, atol=1e-9)
            self.assertAlmostEqual(alignment.load(path, 500, 250, 3).warps[1][0, 2], warps[1][0, 2] / 2)
            for text, words in (('{}', 'no alignment'), ('[]', 'no alignment'), (path.read_text().replace('1000', '"x"', 1), 'no alignment')):
                path.write_text(text)
                with self.assertRaisesRegex(Unusable, words):
                    alignment.load(path, 1000, 500, 3)


class Interrupts(unittest.TestCase):
    def setUp(self):
        engine.start()

    def test_one_inside_a_call_is_one(self):
        within = SystemError('a call returned a result with an exception set')
        within.__cause__ = KeyboardInterrupt()
        for error, becomes in ((KeyboardInterrupt(), KeyboardInterrupt), (within, KeyboardInterrupt), (SystemError('other'), SystemError)):
            with self.assertRaises(becomes), engine.running('appsrc ! appsink', print):
                raise error


class Writing(unittest.TestCase):
    def test_cameras_that_say_nothing_in_many_words(self):
        """OpenImageIO aborts where it is to write an empty text."""
        first = oiio.ImageSpec(64, 64, 3, oiio.UINT8)
        for name in ('Artist', 'Copyright', 'Make', 'IPTC:Caption', 'Exif:UserComment', 'XResolution'):
            first[name] = ''
        with tempfile.TemporaryDirectory() as name:
            for ending in ('jpg', 'tif', 'png', 'exr'):
                with results.together() as files:
                    results.write_picture(files, pathlib.Path(name, 'a.' + ending), np.zeros((64, 64, 3), np.uint8), first, 'a picture')
                self.assertTrue(pathlib.Path(name, 'a.' + ending).exists())

    def test_links_stay_links(self):
        with tempfile.TemporaryDirectory() as name:
            elsewhere, link = pathlib.Path(name, 'there/b.json'), pathlib.Path(name, 'a.json')
            elsewhere.parent.mkdir()
            link.symlink_to('there/b.json')
            with results.together() as files:
                files.begin(link).write_text('written')
            self.assertTrue(link.is_symlink())
            self.assertEqual(elsewhere.read_text(), 'written')

    def test_texts_longer_than_a_block_of_jpeg(self):
        """At which libjpeg would end the program. Other files keep them."""
        first = oiio.ImageSpec(64, 64, 3, oiio.UINT8)
        first['Artist'], first['Copyright'], first['Exif:UserComment'], first['Make'] = 'A' * 70000, '&' * 30000, 'C' * 30000, 'Maker'
        with tempfile.TemporaryDirectory() as name:
            for ending in ('jpg', 'tif', 'png', 'exr'):
                path = pathlib.Path(name, 'a.' + ending)
                with results.together() as files:
                    results.write_picture(files, path, np.zeros((64, 64, 3), np.uint8), first, 'a picture')
                spec = pictures.pages_of(path)[0].spec
                self.assertEqual(spec.get_string_attribute('Make'), 'Maker')
                self.assertEqual(len(spec.get_string_attribute('Artist')) > 60000, ending != 'jpg', ending)

    def test_letters_of_another_code(self):
        """OpenImageIO gives them as they are in the file."""
        with tempfile.TemporaryDirectory() as name:
            spec = oiio.ImageSpec(64, 64, 3, oiio.UINT8)
            spec['Artist'], spec['Software'], spec['ImageDescription'], spec['DateTime'] = 'Mxller', 'Mxller', 'Mxller', 'Mxller'
            path = pathlib.Path(name, 'a.jpg')
            output = oiio.ImageOutput.create(str(path))
            assert output.open(str(path), spec) and output.write_image(np.zeros((64, 64, 3), np.uint8)) and output.close()
            path.write_bytes(path.read_bytes().replace(b'Mxller', b'M\xfcller'))
            picture, = ome.place_pages(pictures.pages_of(path), print)[0]
            self.assertFalse(picture.is_result)
            for ending in ('jpg', 'tif', 'png', 'exr'):
                with results.together() as files:
                    results.write_picture(files, pathlib.Path(name, 'b.' + ending), picture.pixels('u1'), picture.spec, 'a picture')
                self.assertIn(b'M\xfcller', pathlib.Path(name, 'b.' + ending).read_bytes(), ending)


class Arrays:
    """Planes that are there already."""

    def __init__(self, planes):
        self.planes, self.encoding = planes, RGB
        self.count, self.size = len(planes), planes[0].shape[1::-1]

    def read(self, number, keep=False):
        return self.planes[number]


class Seams(unittest.TestCase):
    """What is computed in parts is what is computed at once."""

    @classmethod
    def setUpClass(cls):
        engine.start()
        cls.planes = [np.round(plane).astype(np.uint8) for plane in many_planes()]
        cls.whole = cls.solve(slabs.slabs_of(MANY, MANY), 1)

    @classmethod
    def solve(cls, spans, columns):
        source = Arrays(cls.planes)

        def plan_of(source, warps, work):
            chosen = spans if source.count == MANY else [(0, source.count)]
            margin = 48 if columns > 1 else 0
            return slabs.Plan(chosen, slabs.tiles_of(*source.size, columns, 1, margin), margin)

        kept, solve.plan_of = solve.plan_of, plan_of
        try:
            work = solve.Work(GIB, False, Progress(quiet=True), lambda text: None)
            return solve.solve(source, None, work)
        finally:
            solve.plan_of = kept

    def assert_no_seam(self, parts):
        inner = np.s_[16:-16, 24:-24]
        off = np.abs(parts.depth - self.whole.depth)[inner]
        self.assertLess(np.median(off), 0.1)
        self.assertLess(np.quantile(off, 0.95), 1)
        of_columns = np.median(parts.depth[inner], 0) - np.median(self.whole.depth[inner], 0)
        self.assertLess(np.abs(np.diff(of_columns)).max(), 0.25, 'a step of depth from column to column')
        picture = np.abs(parts.picture.astype(float) - self.whole.picture)[inner]
        self.assertLess(picture.mean(), 1)

    def test_a_disk_that_is_full_is_named(self):
        files = solve.SlabFiles('/dev/full', RGB, (4, 4))
        with self.assertRaisesRegex(Unusable, '/dev/full cannot hold .*TMPDIR'):
            files.add((0, 3), self.whole)

    def test_of_slabs(self):
        self.assert_no_seam(self.solve(slabs.slabs_of(MANY, 14), 1))

    def test_what_is_said_of_slabs_that_are_joined_is_not_told(self):
        """The pictures of two slabs may be equally sharp everywhere without anything being wrong."""
        told = []

        def solve_slab(source, span, kept, warps, plan, work):
            work.tell(f'of {source.count}')
            return self.whole

        def plan_of(source, warps, work):
            return slabs.Plan([(0, 4), (2, 6)] if source.count > 2 else [(0, 2)], [slabs.Tile(0, 0, *source.size)], 0)

        with mock.patch.object(solve, 'solve_slab', solve_slab), mock.patch.object(solve, 'plan_of', plan_of):
            solve.solve(Arrays(self.planes[:6]), None, solve.Work(GIB, False, Progress(quiet=True), told.append))
        self.assertEqual(told, ['of 6', 'of 6'])

    def test_memory_does_not_grow_from_slab_to_slab(self):
        def resident():  # of our own: pages of files come and go as the system likes
            status = pathlib.Path('/proc/self/status').read_text()
            return 1024 * int(status.split('RssAnon:')[1].split()[0])

        after = []
        for _ in range(4):
            self.solve(slabs.slabs_of(MANY, 14), 1)
            after.append(resident())
        # What is kept grows each time; what threads of the device hold for a while does not.
        self.assertLess(np.diff(after).min(), 8 * 2 ** 20, after)

    def test_of_tiles(self):
        self.assert_no_seam(self.solve([(0, MANY)], 2))


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
