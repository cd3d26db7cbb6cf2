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
import scores

PLANES = evaluate.PLANES


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
        self.assertEqual((found['mae'], found['off_by_plane']), (0, 0))

    def test_half_a_plane_off_everywhere(self):
        found = self.depth(self.truth + 0.5)
        self.assertAlmostEqual(found['psnr'], 20 * np.log10(2 * (PLANES - 1)))
        self.assertAlmostEqual(found['mae'], 255 / 2 / (PLANES - 1))
        self.assertEqual(found['off_by_plane'], 0)

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


class Elements(unittest.TestCase):
    def test_elements_find_the_depth_of_a_textured_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder)
            make_scene(scene)
            found = evaluate.score_scene(evaluate.FileScene(scene), evaluate.Conditions('', 'moderate', 0, 2))
        self.assertGreater(found['psnr'], 15)
        self.assertGreater(found['aif_psnr'], 25)

    def test_made_scenes_know_their_depth(self):
        found = evaluate.score_scene(evaluate.MadeScene(5, (320, 240)), evaluate.Conditions('', 'none', 0, 2))
        self.assertGreater(found['psnr'], 15)
        self.assertNotIn('aif_psnr', found)

    def test_breathing_undone_leaves_depth_where_the_truth_is(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder)
            make_scene(scene)
            still, undone = (evaluate.score_scene(evaluate.FileScene(scene), evaluate.Conditions('', 'none', breathing, 2))
                             for breathing in (0, 0.03))
        self.assertGreater(undone['psnr'], still['psnr'] - 0.7)


if __name__ == '__main__':
    unittest.main()
