# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Other people's ways from a focal stack to depth, written anew from their papers, and to a picture, by their programs.

Depth: planes (N, height, width), luma of 0..255, in; plane positions out.
"""
import shutil
import subprocess

import cv2
import numpy as np
import scipy.fft

WINDOW = 9  # pixels over which a focus measure is summed up


def modified_laplacian(planes):
    """Nayar and Nakagawa 1994: |2 I(x) - I(x-1) - I(x+1)| + the same along y."""
    result = []
    for plane in planes:
        plane = plane.astype(np.float32)
        along_x = cv2.filter2D(plane, -1, np.array([[-1, 2, -1]], np.float32))
        along_y = cv2.filter2D(plane, -1, np.array([[-1], [2], [-1]], np.float32))
        result.append(np.abs(along_x) + np.abs(along_y))
    return np.stack(result)


def summed(measure, window=WINDOW):
    return np.stack([cv2.blur(plane, (window, window)) for plane in measure])


def vertex(measure):
    """Positions of the greatest measure, between planes by a Gaussian through three (Nayar and Nakagawa's (20))."""
    best = np.clip(measure.argmax(0), 1, len(measure) - 2)[None]
    before, here, after = (np.log(np.take_along_axis(measure, best + i, 0)[0] + 1e-3) for i in (-1, 0, 1))
    bend = 2 * here - before - after
    return best[0] + np.where(bend > 1e-6, np.clip((after - before) / (2 * np.maximum(bend, 1e-6)), -1, 1), 0)


def sum_modified_laplacian(planes):
    return vertex(summed(modified_laplacian(planes)))


def per_pixel(planes):
    """In the manner of Hui et al., Appl. Opt. 55 (2016): the plane of the greatest squared gradient around, each pixel for itself;
    then a median."""
    energy = np.stack([cv2.Sobel(plane, cv2.CV_32F, 1, 0) ** 2 + cv2.Sobel(plane, cv2.CV_32F, 0, 1) ** 2
                       for plane in planes.astype(np.float32)])
    return cv2.medianBlur(summed(energy).argmax(0).astype(np.uint8), 5).astype(float)


class Contrast:
    """The contrast of every pixel as a polynomial of depth, fitted to what the planes measure; depth runs from -1 to 1."""

    DEGREE = 8

    def __init__(self, measure):
        count = len(measure)
        basis = np.polynomial.legendre.legvander(np.linspace(-1, 1, count), min(self.DEGREE, count - 2))
        legendre = np.tensordot(np.linalg.pinv(basis), measure, 1)
        powers = np.stack([np.pad(np.polynomial.legendre.leg2poly(row), (0, len(legendre)))[:len(legendre)]
                           for row in np.eye(len(legendre))])
        coefficients = np.tensordot(powers.T, legendre, 1)
        self.slope_terms = coefficients[1:] * np.arange(1, len(coefficients))[:, None, None]

    def slope(self, depth):
        result = np.zeros_like(depth)
        for term in self.slope_terms[::-1]:
            result = result * depth + term
        return result


def differences(depth):
    """Forward, 0 at the far borders."""
    return np.stack([np.diff(depth, axis=1, append=depth[:, -1:]), np.diff(depth, axis=0, append=depth[-1:])])


def divergence(field):
    """Minus the adjoint of differences()."""
    x, y = field[0].copy(), field[1].copy()
    x[:, -1] = 0
    y[-1] = 0
    return np.diff(x, axis=1, prepend=0) + np.diff(y, axis=0, prepend=0)


def variational(planes, alpha=3.0, penalty=100.0, step=0.005, iterations=250):
    """Moeller et al., IEEE Trans. Image Process. 24 (2015): min over d of -sum c(d) + alpha TV(d), c the modified Laplacian's contrast
    as a polynomial of depth, by an alternating directions method of multipliers whose data term, which is not convex, is linearised:

        d = argmin step/2-proximal <D'(d_k), d> + penalty/2 |K d - v + b|^2,  v = shrink(K d + b, alpha / penalty),  b += K d - v.

    The quadratic problem is solved by cosine transforms. Contrast is scaled so that the mean of its peaks is 1."""
    measure = summed(modified_laplacian(planes), 5)
    contrast = Contrast(measure / measure.max(0).mean())
    height, width = planes.shape[1:]
    depth = (cv2.medianBlur(measure.argmax(0).astype(np.uint8), 5) * 2.0 / (len(planes) - 1) - 1).astype(np.float64)
    waves = 2 - 2 * np.cos(np.pi * np.arange(width) / width) + (2 - 2 * np.cos(np.pi * np.arange(height) / height))[:, None]
    field = differences(depth)
    multiplier = np.zeros_like(field)
    for _ in range(iterations):
        right = depth + step * contrast.slope(depth) - step * penalty * divergence(field - multiplier)
        depth = np.clip(scipy.fft.idctn(scipy.fft.dctn(right, norm='ortho') / (1 + step * penalty * waves), norm='ortho'), -1, 1)
        moved = differences(depth) + multiplier
        length = np.sqrt((moved ** 2).sum(0))
        field = moved * np.maximum(1 - alpha / penalty / np.maximum(length, 1e-9), 0)
        multiplier = moved - field
    return (depth + 1) / 2 * (len(planes) - 1)


DEPTH = {'sum-modified Laplacian, Gaussian': sum_modified_laplacian,
         'per pixel, in the manner of Hui et al. 2016': per_pixel,
         'VDFF, written anew from Moeller et al. 2015': variational}

# Programs that make a picture of aligned files, in order: what they are called with.
PICTURE = {'enfuse': ['--exposure-weight=0', '--saturation-weight=0', '--contrast-weight=1', '--hard-mask', '--output={picture}',
                      '{files}'],
           'focusweave': ['{folder}', '--no-align', '--output', '{picture}'],
           'focus-stack': ['--no-whitebalance', '--no-contrast', '--align-keep-size', '--output={picture}', '{files}']}


def installed():
    return [name for name in PICTURE if shutil.which(name)]


def make_picture(name, folder, picture):
    """Runs a program on the files of a folder; returns the picture."""
    files = [str(file) for file in sorted(folder.iterdir())]
    arguments = []
    for argument in PICTURE[name]:
        arguments += files if argument == '{files}' else [argument.format(picture=picture, folder=folder)]
    subprocess.run([name, *arguments], check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return cv2.imread(str(picture))
