#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The scoring itself, on errors that are known, and the built elements on a scene made here."""
import pathlib
import tempfile
import unittest

import cv2
import numpy as np

import evaluate
import flicker
import halo
import peers
import scenes
import scores

PLANES = scenes.PLANES


def make_scene(folder):
    """A textured slanted ground with a nearer textured square."""
    random = np.random.default_rng(7)
    texture = cv2.resize(random.integers(0, 256, (60, 80, 3), np.uint8), (320, 240), interpolation=cv2.INTER_LINEAR)
    disparity = np.repeat(np.linspace(60, 140, 240).astype(np.uint8)[:, None], 320, axis=1)
    disparity[60:160, 110:210] = 200
    disparity[:, :4] = 0
    cv2.imwrite(str(folder / 'view.png'), texture)
    cv2.imwrite(str(folder / 'disp.png'), disparity)
    return texture, disparity


class Scoring(unittest.TestCase):
    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            self.view, disparity = make_scene(pathlib.Path(folder))
        self.truth, self.known = scores.true_depth(disparity, PLANES)

    def depth(self, u):
        return scores.depth_scores(u, self.truth, self.known, PLANES)

    def test_truth_spans_the_planes_and_nearer_is_smaller(self):
        self.assertEqual(self.truth[self.known].min(), 0)
        self.assertEqual(self.truth[self.known].max(), PLANES - 1)
        self.assertLess(self.truth[100, 150], self.truth[10, 150])

    def test_perfect_depth(self):
        found = self.depth(self.truth)
        self.assertGreater(found['psnr'], 100)
        self.assertEqual((found['mae'], found['off_by_plane'], found['abs_rel'], found['delta_105']), (0, 0, 0, 100))

    def test_half_a_plane_off_everywhere(self):
        found = self.depth(self.truth + 0.5)
        self.assertAlmostEqual(found['psnr'], 20 * np.log10(2 * (PLANES - 1)))
        self.assertAlmostEqual(found['mae'], 255 / 2 / (PLANES - 1))
        self.assertEqual(found['off_by_plane'], 0)

    def test_parts_of_the_distance(self):
        far = np.full((10, 10), PLANES - 1.0)
        found = scores.depth_scores(far - 0.4, far, far > 0, PLANES)
        metres = 1 / (scores.FAR + 0.4 * (scores.NEAR - scores.FAR) / (PLANES - 1))
        self.assertAlmostEqual(found['abs_rel'], 100 * abs(metres * scores.FAR - 1))
        self.assertEqual(found['delta_105'], 100)
        self.assertEqual(scores.depth_scores(far - 0.5, far, far > 0, PLANES)['delta_105'], 0)

    def test_stairs_have_no_slope_and_the_truth_has_one(self):
        truth = np.repeat(np.linspace(0, PLANES - 1, 500)[None], 10, axis=0)
        everywhere = np.full(truth.shape, True)
        for share in (0, 0.4, 1):
            found = scores.locking_scores(np.rint(truth) + share * (truth - np.rint(truth)), truth, everywhere, PLANES)
            self.assertAlmostEqual(found['slope'], share)
        self.assertAlmostEqual(found['rms'], 0)

    def test_two_planes_off_in_a_quarter(self):
        u = self.truth.copy()
        quarter = np.flatnonzero(self.known)[::4]
        u.flat[quarter] += 2
        self.assertAlmostEqual(self.depth(u)['off_by_plane'], 25, places=1)

    def test_pixels_without_truth_do_not_count(self):
        self.assertGreater(self.depth(np.where(self.known, self.truth, 99))['psnr'], 100)

    def test_average_is_of_ratios(self):
        self.assertAlmostEqual(scores.average_psnr([20, 30]), 10 * np.log10(550))

    def test_all_in_focus(self):
        perfect = scores.all_in_focus_scores(self.view, self.view)
        self.assertGreater(perfect['aif_psnr'], 100)
        self.assertAlmostEqual(perfect['aif_ssim'], 1)
        moved = scores.all_in_focus_scores(np.clip(self.view, 10, 245) + np.uint8(10), np.clip(self.view, 10, 245))
        self.assertAlmostEqual(moved['aif_psnr'], 20 * np.log10(25.5))


class PicturesOfPlanes(unittest.TestCase):
    """Made of two planes whose halves are sharp in turn."""

    def setUp(self):
        texture = np.random.default_rng(3).integers(0, 256, (256, 256, 3)).astype(np.float32)
        self.sharp, blurred = cv2.GaussianBlur(texture, (0, 0), 1), cv2.GaussianBlur(texture, (0, 0), 6)
        left = np.arange(256)[None, :, None] < 128
        self.planes = [np.where(left, self.sharp, blurred), np.where(left, blurred, self.sharp)]

    def test_the_sharp_picture_has_all_and_invents_nothing(self):
        found = scores.real_scores(self.sharp, self.planes)
        self.assertEqual(found['invented'], 0)
        self.assertAlmostEqual(found['tile'], 1, places=2)

    def test_a_line_that_no_plane_has_is_invented(self):
        drawn = self.sharp.copy()
        drawn[:, 100] = 255 * (np.arange(256)[:, None] % 2 + 2)
        self.assertGreater(scores.real_scores(drawn, self.planes)['invented'], 5)

    def test_half_of_the_sharpness(self):
        weak = 128 + (self.sharp - 128) / np.sqrt(2)
        self.assertAlmostEqual(scores.real_scores(weak, self.planes)['tile'], 0.5, places=2)

    def test_haloes(self):
        planes, sharp, truth, shapes = halo.stack(0, 5, 6.0, 2, 4)
        self.assertEqual((truth[shapes].max(), truth[~shapes].min()), (2, 4))
        kept = scores.halo_scores(sharp, sharp, planes)
        self.assertLess(kept['below_best'], 0)
        self.assertEqual(kept['halo'], 0)
        blurred = scores.halo_scores(planes[4], sharp, planes)
        self.assertGreater(blurred['below_best'], 1)
        self.assertGreater(blurred['halo'], 0.3)


class Flicker(unittest.TestCase):
    def setUp(self):
        self.picture = np.tile(np.linspace(20, 220, 256, dtype=np.float32)[:, None, None], (1, 256, 3))

    def test_planes_flicker_by_what_is_told(self):
        kinds = flicker.flickers(1, 7)
        gains = [kinds['gain 12 %'](z, self.picture).mean() / self.picture.mean() for z in range(7)]
        self.assertAlmostEqual(np.mean(gains), 1, places=4)
        self.assertAlmostEqual(np.std(gains), 0.12, places=4)

    def test_mottle_is_what_no_gain_explains(self):
        self.assertAlmostEqual(flicker.mottle(1.2 * self.picture + 5, self.picture), 0, places=2)
        mottled = self.picture.copy()
        mottled[:, :128] += 20
        self.assertGreater(flicker.mottle(mottled, self.picture), 2)

    def test_moved_is_of_textured_pixels(self):
        truth, textured = np.zeros((64, 64)), np.zeros((64, 64), bool)
        textured[:, :32] = True
        depth = truth.copy()
        depth[:16, :16], depth[:, 32:] = 1.5, 3
        self.assertAlmostEqual(flicker.moved(depth, truth, textured), 12.5)


class Peers(unittest.TestCase):
    def test_other_ways_find_which_half_is_sharp(self):
        texture = np.random.default_rng(5).integers(0, 256, (96, 128)).astype(np.float32)
        left = np.arange(128)[None] < 64
        planes = np.stack([np.where(left, cv2.GaussianBlur(texture, (0, 0), 1 + abs(z - 1)),
                                    cv2.GaussianBlur(texture, (0, 0), 1 + abs(z - 3))) for z in range(5)])
        for name, depth in peers.DEPTH.items():
            found = depth(planes.astype(np.uint8))
            with self.subTest(name):
                self.assertAlmostEqual(np.median(found[:, :48]), 1, delta=0.6)
                self.assertAlmostEqual(np.median(found[:, 80:]), 3, delta=0.6)


class Elements(unittest.TestCase):
    def test_elements_find_the_depth_of_a_textured_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder)
            make_scene(scene)
            found = evaluate.score_scene(scenes.FileScene(scene), evaluate.Conditions('', 'moderate', 0, 2))
        self.assertGreater(found['psnr'], 15)
        self.assertGreater(found['aif_psnr'], 25)

    def test_made_scenes_know_their_depth(self):
        found = evaluate.score_scene(scenes.MadeScene('shapes', 5, (320, 240)), evaluate.Conditions('', 'none', 0, 2))
        self.assertGreater(found['psnr'], 15)
        self.assertNotIn('aif_psnr', found)

    def test_a_folder_of_planes_or_of_photographs(self):
        with tempfile.TemporaryDirectory() as name:
            given, photographs = pathlib.Path(name) / 'given', pathlib.Path(name) / 'photographs'
            given.mkdir()
            photographs.mkdir()
            planes, sharp, truth, _ = halo.stack(0, 3, 4.0, 0, 2)
            for z, plane in enumerate(planes):
                cv2.imwrite(str(given / f'plane_{z}.png'), plane.astype(np.uint8))
                cv2.imwrite(str(photographs / f'{9 - z}.jpg'), plane.astype(np.uint8))
            cv2.imwrite(str(given / 'sharp.png'), sharp.astype(np.uint8))
            cv2.imwrite(str(given / 'truth.png'), (1 + truth * 65534 // 2).astype(np.uint16))
            here = evaluate.Conditions('', 'none', 0, 2, 'sharp')
            found = evaluate.score_scene(scenes.scene_in(given), here)
            real = evaluate.score_scene(scenes.scene_in(photographs, ['photographs']), here)
        self.assertGreater(found['aif_psnr'], 25)
        self.assertGreater(real['tile'], 0.8)

    def test_haloes_are_scored(self):
        found = evaluate.score_scene(scenes.HaloScene(0, 0), evaluate.Conditions('', 'none', 0, 4))
        self.assertIn('shapes_off', found)
        self.assertLess(found['halo'], 100)

    def test_breathing_undone_leaves_depth_where_the_truth_is(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder)
            make_scene(scene)
            still, undone = (evaluate.score_scene(scenes.FileScene(scene), evaluate.Conditions('', 'none', breathing, 2))
                             for breathing in (0, 0.03))
        self.assertGreater(undone['psnr'], still['psnr'] - 0.7)


if __name__ == '__main__':
    unittest.main()
