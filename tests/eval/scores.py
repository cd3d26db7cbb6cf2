# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How good a depth map and an all-in-focus image are. Equation numbers are those of Oliva-García et al., Appl. Sci. 2022, 12, 3141.

Depth is u, the plane position: 0 the nearest plane, planes - 1 the farthest, linear in dioptres.
"""
import math

import cv2
import numpy as np
from skimage.metrics import structural_similarity

PEAK = 255.0
BORDER = 8  # pixels of the all-in-focus image that are not scored, where the blur reaches beyond the picture


def psnr(mean_square_error):
    """(9), in dB, for errors on a scale of 0..255."""
    return 10 * math.log10(PEAK * PEAK / max(mean_square_error, 1e-12))


def average_psnr(values):
    """(10): the average of the linear ratios, in dB."""
    return 10 * math.log10(np.mean(10 ** (np.asarray(values) / 10)))


def true_depth(disparity, planes):
    """Plane positions and the mask of the pixels whose truth is known, from a disparity map in which 0 is unknown.

    The planes span the 0.2 to the 99.8 percentile of the known disparities. What is unknown has position 0.
    """
    known = disparity > 0
    low, high = np.percentile(disparity[known].astype(np.float32), [0.2, 99.8])
    u = (high - np.clip(disparity.astype(np.float32), low, high)) / (high - low) * (planes - 1)
    return np.where(known, u, 0), known


def depth_scores(u, truth, known, planes):
    """PSNR (9), mean absolute error on 0..255, and the per cent of pixels more than one plane off."""
    error = np.abs(u.astype(np.float64) - truth)[known]
    level = error * PEAK / (planes - 1)
    return {'psnr': psnr(float((level * level).mean())), 'mae': float(level.mean()),
            'off_by_plane': float((error > 1).mean() * 100)}


def all_in_focus_scores(image, sharp):
    """PSNR in dB over the three channels, and SSIM of the gray image."""
    inner = np.s_[BORDER:-BORDER, BORDER:-BORDER]
    image, sharp = image[inner], sharp[inner]
    error = image.astype(np.float64) - sharp
    gray = [cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY) for picture in (image, sharp)]
    return {'aif_psnr': psnr(float((error * error).mean())),
            'aif_ssim': float(structural_similarity(*gray, data_range=255))}
