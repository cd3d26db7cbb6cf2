# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A surface with the picture on it, as binary glTF, which any 3D viewer opens."""
import json
import struct

import numpy as np

from dff_stack import SOFTWARE, cloud, results, video

MOST_VERTICES = 1000 * 1000
LARGEST_TEXTURE = 4096       # pixels in each direction
MOST_STEP = 0.05             # of the extent of depth, between neighbours; beyond it the surface is torn
ARRAY, ELEMENTS = 34962, 34963
FLOAT, UNSIGNED = 5126, 5125


def grid_step(width, height):
    """Pixels between vertices."""
    return max(1, int(np.ceil(np.sqrt(width * height / MOST_VERTICES))))


def triangles(depth, most_step):
    """Two for each square of neighbours that are all known and about as deep; numbers of vertices."""
    height, width = depth.shape
    corners = np.stack([depth[:-1, :-1], depth[:-1, 1:], depth[1:, :-1], depth[1:, 1:]])
    is_whole = (corners.max(0) - corners.min(0)) <= most_step  # false where one is not known
    upper_left = np.arange(height * width, dtype=np.uint32).reshape(height, width)[:-1, :-1][is_whole]
    a, b, c, d = upper_left, upper_left + 1, upper_left + width, upper_left + width + 1
    return np.stack([a, c, b, b, c, d], 1).reshape(-1, 3)


def texture(colours):
    """The bytes of a JPEG picture."""
    factor = -(-max(colours.shape[:2]) // LARGEST_TEXTURE)
    pixels = cloud.colours_of_8_bits(colours)
    if factor > 1:
        pixels = video.shrunk(np.ascontiguousarray(pixels), (pixels.shape[1] // factor, pixels.shape[0] // factor))
    return results.encoded(pixels, results.plain_spec(np.ascontiguousarray(pixels), SOFTWARE), 'texture.jpg')


def surface(depth, pixel_scale, depth_scale, most_step):
    """Vertices that are used, where in the picture each lies (0..1), and the triangles between them."""
    height, width = depth.shape
    step = grid_step(width, height)
    sampled = depth[::step, ::step]
    faces = triangles(sampled, most_step)
    used, faces = np.unique(faces, return_inverse=True)
    faces = faces.reshape(-1, 3).astype(np.uint32)
    vertices = cloud.points(sampled, pixel_scale * step, depth_scale).reshape(-1, 3)[used].astype(np.float32)
    rows, columns = np.divmod(used, sampled.shape[1])
    places = np.stack([(columns * step + 0.5) / width, (rows * step + 0.5) / height], 1).astype(np.float32)
    return vertices, places, faces


class Parts:
    """The binary half of a file, and the tables of what lies where in it."""

    def __init__(self):
        self.data, self.views, self.accessors = b'', [], []

    def add(self, data, target=None):
        view = {'buffer': 0, 'byteOffset': len(self.data), 'byteLength': len(data)}
        self.views.append({**view, 'target': target} if target else view)
        self.data += data + b'\0' * (-len(data) % 4)
        return len(self.views) - 1

    def add_array(self, values, component, kind, target, **bounds):
        view = self.add(np.ascontiguousarray(values).tobytes(), target)
        self.accessors.append({'bufferView': view, 'componentType': component, 'count': len(values), 'type': kind, **bounds})
        return len(self.accessors) - 1


def chunk(kind, data, filler):
    data += filler * (-len(data) % 4)
    return struct.pack('<I', len(data)) + kind + data


def glb(vertices, places, faces, picture):
    parts = Parts()
    bounds = {'min': vertices.min(0).tolist(), 'max': vertices.max(0).tolist()}
    position = parts.add_array(vertices, FLOAT, 'VEC3', ARRAY, **bounds)
    place = parts.add_array(places, FLOAT, 'VEC2', ARRAY)
    face = parts.add_array(faces.reshape(-1), UNSIGNED, 'SCALAR', ELEMENTS)
    image = parts.add(picture)
    material = {'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}, 'metallicFactor': 0, 'roughnessFactor': 1},
                'doubleSided': True, 'extensions': {'KHR_materials_unlit': {}}}
    facts = {'asset': {'version': '2.0', 'generator': SOFTWARE}, 'extensionsUsed': ['KHR_materials_unlit'], 'scene': 0,
             'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
             'meshes': [{'primitives': [{'attributes': {'POSITION': position, 'TEXCOORD_0': place}, 'indices': face, 'material': 0}]}],
             'materials': [material], 'textures': [{'source': 0}], 'images': [{'bufferView': image, 'mimeType': 'image/jpeg'}],
             'accessors': parts.accessors, 'bufferViews': parts.views, 'buffers': [{'byteLength': len(parts.data)}]}
    body = chunk(b'JSON', json.dumps(facts).encode(), b' ') + chunk(b'BIN\0', parts.data, b'\0')
    return b'glTF' + struct.pack('<II', 2, 12 + len(body)) + body


def write(path, depth, colours, extent, scales):
    """`scales`: of a pixel and of a unit of depth. The surface is made one unit wide, as viewers like it. False: no depth is known."""
    pixel_scale, depth_scale = scales
    shrink = 1 / (depth.shape[1] * pixel_scale)
    vertices, places, faces = surface(depth, pixel_scale * shrink, depth_scale * shrink, MOST_STEP * (extent[1] - extent[0]))
    if not len(faces):
        return False
    path.write_bytes(glb(vertices, places, faces, texture(colours)))
    return True
