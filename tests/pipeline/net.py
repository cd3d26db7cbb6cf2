# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A sweep over a net of thin threads before a textured ground that is a little brighter, which shows through them."""
import numpy as np

WIDTH, HEIGHT, PLANES = 384, 256, 11
NEAR, FAR = 2, 8     # planes in which threads and ground are sharp
STEP = 3.0           # pixels of blur a plane
THREAD, EVERY = 3, 64
TONE = 100, 110, 120


def disc(size):
    """Of so many pixels in diameter, around the corner of a picture."""
    y, x = (np.minimum(np.arange(length), length - np.arange(length)) for length in (HEIGHT, WIDTH))
    found = np.clip(size / 2 + 0.5 - np.hypot(y[:, None], x[None]), 0, 1)
    return found / found.sum()


def convolved(picture, spectrum):
    return np.fft.irfft2(np.fft.rfft2(picture, axes=(0, 1)) * spectrum[:, :, None], (HEIGHT, WIDTH), (0, 1))


def blurred(picture, size):
    return picture if size < 1 else convolved(picture, np.fft.rfft2(disc(size)))


def ground(random):
    """Colours of several scales."""
    squares = np.fft.fftfreq(HEIGHT)[:, None] ** 2 + np.fft.rfftfreq(WIDTH)[None] ** 2
    found = sum(sigma * convolved(random.standard_normal((HEIGHT, WIDTH, 3)), np.exp(-2 * (np.pi * sigma) ** 2 * squares))
                for sigma in (0.7, 2, 6))
    return 150 + 35 * found / found.std()


def threads():
    """1 where one is."""
    found = np.zeros((HEIGHT, WIDTH, 1))
    for first in range(EVERY // 2, WIDTH, EVERY):
        found[:, first:first + THREAD] = 1
    for first in range(EVERY // 2, HEIGHT, EVERY):
        found[first:first + THREAD] = 1
    return found


def sweep():
    """The pictures, and what the ground is without threads."""
    random = np.random.default_rng(4)
    behind, before, pictures = ground(random), threads(), []
    for plane in range(PLANES):
        cover = blurred(before, STEP * abs(plane - NEAR))
        light = blurred(behind, STEP * abs(plane - FAR)) * (1 - cover) + cover * np.array(TONE) + random.normal(0, 1, behind.shape)
        pictures.append(np.ascontiguousarray(light.clip(0, 255).round().astype(np.uint8)))
    return pictures, behind.clip(0, 255)
