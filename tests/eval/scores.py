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
NEAR, FAR = 2.0, 1.0  # dioptres: what the planes are taken to span where errors are told as parts of the distance
BESIDE_PLANE = 0.3  # planes from a plane within which locking is measured
TILE = 32  # pixels


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


def distance(u, planes):
    """Metres, of planes from NEAR to FAR."""
    return 1 / (NEAR + (FAR - NEAR) * np.asarray(u, np.float64) / (planes - 1))


def depth_scores(u, truth, known, planes):
    """PSNR (9), mean absolute error on 0..255, and the per cent of pixels more than one plane off. As parts of the
    distance, of planes from NEAR to FAR: the mean error in per cent, and the per cent of pixels within a factor of 1.05."""
    error = np.abs(u.astype(np.float64) - truth)[known]
    level = error * PEAK / (planes - 1)
    ratio = distance(u[known], planes) / distance(truth[known], planes)
    return {'psnr': psnr(float((level * level).mean())), 'mae': float(level.mean()),
            'off_by_plane': float((error > 1).mean() * 100),
            'abs_rel': float(np.abs(ratio - 1).mean() * 100),
            'delta_105': float((np.maximum(ratio, 1 / ratio) < 1.05).mean() * 100)}


def locking_scores(u, truth, known, planes):
    """How much depth sticks to the planes: the slope of what is found against the truth beside a plane (1: not at all, 0: stairs),
    of pixels not a plane off; and the root mean square error of these, in planes."""
    plane = np.rint(truth)
    used = known & (np.abs(truth - plane) < BESIDE_PLANE) & (np.abs(u - truth) < 1) & (plane > 0) & (plane < planes - 1)
    slope = np.polyfit((truth - plane)[used], (u - plane)[used], 1)[0]
    right = known & (np.abs(u - truth) < 1)
    return {'slope': float(slope), 'rms': float(np.sqrt(((u - truth)[right] ** 2).mean()))}


def all_in_focus_scores(image, sharp):
    """PSNR in dB over the three channels, and SSIM of the gray image."""
    inner = np.s_[BORDER:-BORDER, BORDER:-BORDER]
    image, sharp = image[inner], sharp[inner]
    error = image.astype(np.float64) - sharp
    gray = [cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY) for picture in (image, sharp)]
    return {'aif_psnr': psnr(float((error * error).mean())),
            'aif_ssim': float(structural_similarity(*gray, data_range=255))}


def picture_psnr(image, sharp):
    """In dB, the whole picture."""
    return psnr(float(((image.astype(np.float64) - sharp) ** 2).mean()))


def halo_scores(image, sharp, planes):
    """How many dB the picture is worse than the best single plane, and the per cent of pixels more than 20 levels off farther than
    two pixels from an edge."""
    edges = (cv2.Laplacian(sharp.astype(np.float32).mean(2), cv2.CV_32F) > 12).astype(np.uint8)
    away = cv2.dilate(edges, np.ones((5, 5), np.uint8)) == 0
    error = np.abs(image.astype(np.float32) - sharp).max(2)
    best = max(picture_psnr(plane, sharp) for plane in planes)
    return {'below_best': best - picture_psnr(image, sharp), 'halo': float((error[away] > 20).mean() * 100)}


def luma(picture):
    blue, green, red = (picture[..., channel].astype(np.float32) for channel in range(3))
    return blue / 4 + green / 2 + red / 4


def gradient(gray):
    return np.hypot(cv2.Sobel(gray, cv2.CV_32F, 1, 0), cv2.Sobel(gray, cv2.CV_32F, 0, 1)) / 8


def tenengrad(gray):
    """Mean square of the gradient in tiles."""
    height, width = (size // TILE * TILE for size in gray.shape)
    squares = gradient(gray)[:height, :width] ** 2
    return squares.reshape(height // TILE, TILE, width // TILE, TILE).mean((1, 3))


def textured_tiles(least, most):
    """Where there is something to be sharp, from the least and the most that any plane has in each tile."""
    return most > max(4 * np.percentile(least, 20), 0.5, np.percentile(most, 95) * 0.004)


def real_scores(image, planes):
    """Of a picture whose truth nobody knows, beside the planes it was made from. Invented: per mille of pixels whose gradient exceeds 1.3
    times the strongest gradient of any plane within 5x5 by 1.5 levels, lines that no plane has; a rim of 6 % is left out. Tile: the
    median, over textured tiles, of their sharpness as a part of what the sharpest plane has there."""
    strongest, least, most = 0, np.inf, 0
    for plane in planes:
        gray = luma(plane)
        strongest = np.maximum(strongest, gradient(gray))
        least, most = np.minimum(least, tenengrad(gray)), np.maximum(most, tenengrad(gray))
    rim = int(0.06 * image.shape[1])
    strongest = cv2.dilate(strongest, np.ones((5, 5), np.uint8))
    lines = (gradient(luma(image)) > 1.3 * strongest + 1.5)[rim:-rim, rim:-rim]
    textured = textured_tiles(least, most)
    return {'invented': float(lines.mean() * 1000), 'tile': float(np.median(tenengrad(luma(image))[textured] / most[textured]))}
