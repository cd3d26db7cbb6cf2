# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Scenes that make haloes: bright shapes on nearly blank ground, all in one plane or before a ground some planes behind."""
import cv2
import numpy as np

SIZE = 640, 480
SENSOR_NOISE = 1.2  # levels
PARTS = 8  # of a pixel, by which a disk's rim is counted


def ground_and_shapes(seed):
    """The ground, where shapes lie before it (0..1), and their colour."""
    random = np.random.default_rng(seed)
    width, height = SIZE
    ground = np.full((height, width, 3), random.uniform(15, 60, 3), np.float32)
    grain = cv2.GaussianBlur(random.normal(0, 1, (height, width, 1)).astype(np.float32), (0, 0), 1)
    ground += grain[..., None] * random.choice([0, 2, 6])
    mask = np.zeros((height, width), np.uint8)
    for number in range(7):
        x, y, size = int(random.uniform(60, width - 60)), int(random.uniform(60, height - 60)), int(random.uniform(8, 60))
        if number % 3 == 0:
            cv2.circle(mask, (x, y), size, 255, -1, cv2.LINE_AA)
        elif number % 3 == 1:
            cv2.rectangle(mask, (x - size, y - size // 3), (x + size, y + size // 3), 255, -1)
        else:
            text = f'R{random.integers(100)}'
            cv2.putText(mask, text, (x, y), cv2.FONT_HERSHEY_SIMPLEX, size / 18, 255, max(2, size // 8), cv2.LINE_AA)
    return ground, mask.astype(np.float32)[..., None] / 255, random.uniform(200, 245, 3).astype(np.float32)


def disk(diameter):
    """A uniform disk, its rim in PARTS of a pixel; sums up to 1."""
    half = int(np.ceil(diameter / 2))
    at = (np.arange((2 * half + 1) * PARTS) + 0.5) / PARTS - (half + 0.5)
    inside = (at[None] ** 2 + at[:, None] ** 2 <= (diameter / 2) ** 2).astype(np.float32)
    kernel = inside.reshape(2 * half + 1, PARTS, 2 * half + 1, PARTS).sum((1, 3))
    return kernel / kernel.sum()


def blurred(picture, diameter):
    return picture if diameter <= 0.3 else cv2.filter2D(picture, -1, disk(diameter), borderType=cv2.BORDER_REFLECT)


def stack(seed, planes, blur_step, plane, ground_plane):
    """The planes, nearest first; the picture all in focus; the true positions; and where the shapes are. `blur_step`: pixels of the
    blur disk's diameter a plane."""
    ground, mask, colour = ground_and_shapes(seed)
    random = np.random.default_rng(seed + 1)
    frames = []
    for z in range(planes):
        cover = blurred(mask[..., 0], blur_step * abs(z - plane))[..., None]
        frames.append(blurred(ground, blur_step * abs(z - ground_plane)) * (1 - cover) + colour * cover)
    frames = np.stack(frames)
    shapes = mask[..., 0] > 0.5
    return (frames + random.normal(0, SENSOR_NOISE, frames.shape), ground * (1 - mask) + colour * mask,
            np.where(shapes, plane, ground_plane), shapes)
