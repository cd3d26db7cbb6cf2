# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A sweep of a slope that is near at its left."""
import numpy as np

WIDTH, HEIGHT, PLANES = 192, 128, 6


def blurred(pixels, times):
    for _ in range(times):
        pixels = (np.roll(pixels, 1, 0) + 2 * pixels + np.roll(pixels, -1, 0)) / 4
        pixels = (np.roll(pixels, 1, 1) + 2 * pixels + np.roll(pixels, -1, 1)) / 4
    return pixels


def sharp(width=WIDTH, height=HEIGHT):
    """What a sweep is of."""
    return blurred(np.random.default_rng(3).integers(0, 256, (height, width, 3)).astype(float), 1)


def plane(number, scene=None, planes=PLANES):
    """A picture of a slope that is nearest, in focus in picture 0, at its left."""
    scene = sharp() if scene is None else scene
    depth = np.linspace(0, planes - 1, scene.shape[1])
    levels = [blurred(scene, 3 * step) for step in range(planes)]
    away = np.abs(depth - number).clip(0, planes - 1)
    low = away.astype(int)
    part = (away - low)[None, :, None]
    stack = np.stack(levels)
    columns = np.arange(scene.shape[1])
    return (1 - part) * stack[low, :, columns].swapaxes(0, 1) + part * stack[np.minimum(low + 1, planes - 1), :, columns].swapaxes(0, 1)


MANY = 40


def many_planes():
    """A long sweep of a wider slope, with half the blur a plane."""
    scene = sharp(480, 160)
    levels = np.stack([blurred(scene, step) for step in range(MANY)])
    columns = np.arange(scene.shape[1])
    away = [np.abs(np.linspace(0, MANY - 1, scene.shape[1]) - number) for number in range(MANY)]
    for distance in away:
        low, part = distance.astype(int), (distance % 1)[None, :, None]
        above = np.minimum(low + 1, MANY - 1)
        yield (1 - part) * levels[low, :, columns].swapaxes(0, 1) + part * levels[above, :, columns].swapaxes(0, 1)
