#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""photographs.py FOLDER COUNT [WIDTH HEIGHT [BLUR]]: a focus sweep of JPEG pictures, for dff-stack to be measured with.

A scene of 1500x1000 pixels, hills with a step in them, is repeated until the picture is full. Each picture is shifted by up to
three pixels and is up to two percent brighter or darker. Things at one end of the sweep are blurred by BLUR pixels (36) when the
other end is sharp. FOLDER/truth.npy is the depth of the scene in plane numbers.
"""
import pathlib
import sys

import numpy as np
import OpenImageIO as oiio

SIZE = 1500, 1000
LEVELS = 120   # of blur that are computed; others are mixed


def gaussian(spectrum, sigma):
    height, width = SIZE[1], SIZE[0]
    y, x = np.fft.fftfreq(height)[:, None], np.fft.rfftfreq(width)[None]
    return np.fft.irfft2(spectrum * np.exp(-2 * (np.pi * sigma) ** 2 * (x * x + y * y))[:, :, None], (height, width), (0, 1))


def scene(random):
    """Colours of many scales."""
    noise = np.fft.rfft2(random.standard_normal((SIZE[1], SIZE[0], 3)), axes=(0, 1))
    picture = sum(sigma * gaussian(noise, sigma) for sigma in (0.6, 2, 8, 30))
    return 128 + 45 * picture / picture.std()


def depth(count):
    x, y = np.meshgrid(np.linspace(0, 2 * np.pi, SIZE[0], False), np.linspace(0, 2 * np.pi, SIZE[1], False))
    hills = 0.5 + 0.35 * np.sin(x) * np.cos(y) + 0.1 * np.sin(3 * x + 2 * y)
    hills[300:600, 900:1200] = 0.15
    return np.clip(hills, 0, 1) * (count - 1)


def blurred_levels(picture, most):
    spectrum = np.fft.rfft2(picture, axes=(0, 1))
    return np.stack([gaussian(spectrum, most / 2 * level / (LEVELS - 1)).clip(0, 255).astype(np.float16) for level in range(LEVELS)])


def write(path, pixels):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, oiio.UINT8)
    spec['CompressionQuality'] = 92
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(pixels) and output.close(), output.geterror()


def main(folder, count, width=6000, height=4000, blur=36):
    folder, count, width, height = pathlib.Path(folder), int(count), int(width), int(height)
    folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(1)
    levels, truth = blurred_levels(scene(random), float(blur)), depth(count)
    np.save(folder / 'truth.npy', truth.astype(np.float32))
    rows, columns = np.indices(truth.shape)
    for number in range(count):
        level = np.abs(truth - number) / (count - 1) * (LEVELS - 1)
        low = np.minimum(level.astype(int), LEVELS - 2)
        part = (level - low)[:, :, None].astype(np.float32)
        picture = (1 - part) * levels[low, rows, columns] + part * levels[low + 1, rows, columns]
        picture = picture * random.uniform(0.98, 1.02) + random.normal(0, 1, picture.shape)
        repeated = np.tile(picture.clip(0, 255).astype(np.uint8), (-(-height // SIZE[1]), -(-width // SIZE[0]), 1))
        write(folder / f'{number:04}.jpg', np.roll(repeated[:height, :width], tuple(random.integers(-3, 4, 2)), (0, 1)))


main(*sys.argv[1:])
