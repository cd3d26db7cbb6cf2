# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Depth and colours as things in space: x to the right, y up, z towards who looks."""
import numpy as np

from dff_stack import SOFTWARE

RELIEF = 0.2  # of the picture's width: how deep it is made where nobody knows the size of a pixel or the step


def scales(width, extent, unit, pixel_um):
    """Of a pixel and of a unit of depth, so that both are in the same, and what that is."""
    if unit == 'micrometres' and pixel_um:
        return pixel_um, 1.0, 'micrometres'
    return 1.0, RELIEF * width / max(extent[1] - extent[0], 1e-9), 'pixels, the depth stretched to a fifth of the width'


def points(depth, pixel_scale, depth_scale):
    """x, y, z of every pixel."""
    height, width = depth.shape
    x = (np.arange(width, dtype=np.float32) - (width - 1) / 2) * np.float32(pixel_scale)
    y = ((height - 1) / 2 - np.arange(height, dtype=np.float32)) * np.float32(pixel_scale)
    far = np.nanmax(depth) if not np.isnan(depth).all() else 0
    z = (far - depth) * np.float32(depth_scale)
    return np.stack([np.broadcast_to(x[None], depth.shape), np.broadcast_to(y[:, None], depth.shape), z], -1)


def colours_of_8_bits(pixels):
    """Red, green and blue."""
    return np.broadcast_to(pixels[:, :, :3], (*pixels.shape[:2], 3))


def write_ply(path, depth, colours, pixel_scale, depth_scale, unit):
    """Binary PLY of the pixels whose depth is known."""
    known = ~np.isnan(depth)
    vertices = np.empty(int(known.sum()), [('position', '<f4', 3), ('colour', 'u1', 3)])
    vertices['position'] = points(depth, pixel_scale, depth_scale)[known]
    vertices['colour'] = colours_of_8_bits(colours)[known]
    header = ['ply', 'format binary_little_endian 1.0', f'comment {SOFTWARE}, in {unit}', f'element vertex {len(vertices)}',
              *(f'property float {axis}' for axis in 'xyz'), *(f'property uchar {name}' for name in ('red', 'green', 'blue')),
              'end_header\n']
    with open(path, 'wb') as file:
        file.write('\n'.join(header).encode())
        vertices.tofile(file)
