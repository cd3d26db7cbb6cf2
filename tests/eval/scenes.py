# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What is scored on. A scene knows the GStreamer source of its planes, nearest first, and scores what was made of them.

A scene of a folder is one of three: `view.png` and `disp.png`, a sharp picture and its disparity, through whose depth
lenssweeptestsrc sweeps; `plane_*.png` with `sharp.png` and `truth.png`, planes as they are and the truth in the code of
unit=index; or photographs alone, whose truth nobody knows.
"""
import cv2
import numpy as np

import halo
import scores
from elements import depth_in_planes, read_rows, run

PLANES = 10  # of what is simulated


def caps(size):
    return f'video/x-raw,format=BGR,width={size[0]},height={size[1]}'


class Simulated:
    """Swept by lenssweeptestsrc."""

    planes, aligned = PLANES, False

    def source(self, conditions, _):
        return (f'lenssweeptestsrc num-buffers={PLANES} planes={PLANES} {self.content} blur-step={conditions.blur_step} '
                f'noise={conditions.noise} breathing={conditions.breathing} ! {caps(self.size)}')


class FileScene(Simulated):
    """A folder with a picture and its disparity."""

    def __init__(self, folder):
        self.folder, self.name = folder, folder.name
        self.sharp = cv2.imread(str(folder / 'view.png'))
        self.size = self.sharp.shape[1::-1]
        self.content = f'scene=files image="{folder}/view.png" depth-map="{folder}/disp.png" seed=1'

    def truth(self):
        """Plane positions, and where they are known."""
        return scores.true_depth(cv2.imread(str(self.folder / 'disp.png'), cv2.IMREAD_UNCHANGED), PLANES)

    def score(self, result, _):
        return {**scores.depth_scores(result.u, *self.truth(), PLANES),
                **scores.all_in_focus_scores(result.picture, self.sharp)}


class MadeScene(Simulated):
    """What lenssweeptestsrc makes, `shapes` before a wall or a `slant`; no picture of it is sharp everywhere, so that only depth
    is scored, and on a slant how much it sticks to the planes."""

    def __init__(self, kind, seed, size):
        self.kind, self.name, self.size = kind, f'{kind} {seed}', size
        self.content = f'scene={kind} seed={seed}'

    def score(self, result, folder):
        path = folder / 'truth'
        run(f'''lenssweeptestsrc name=t num-buffers={PLANES} planes={PLANES} {self.content}
            t.src ! {caps(self.size)} ! queue ! fakesink  t.depth ! queue ! filesink location={path}''')
        pixels = read_rows(path, self.size[::-1], np.dtype('<u2'), 1)[..., 0]
        truth, known = depth_in_planes(pixels, PLANES), pixels > 0
        found = scores.depth_scores(result.u, truth, known, PLANES)
        return {**found, **scores.locking_scores(result.u, truth, known, PLANES)} if self.kind == 'slant' else found


class Pictures:
    """Planes that are there as files."""

    aligned = False

    def pattern(self, folder):
        """The files by number, as links in `folder`, and their type."""
        for number, file in enumerate(self.files):
            (folder / f'{number:02d}').symlink_to(file.resolve())
        png = self.files[0].suffix.lower() == '.png'
        return folder / '%02d', 'image/png' if png else 'image/jpeg', 'pngdec' if png else 'jpegdec'

    @property
    def planes(self):
        return len(self.files)

    def source(self, _, folder):
        pattern, kind, decoder = self.pattern(folder)
        return (f'multifilesrc location={pattern} stop-index={self.planes - 1} caps={kind},framerate={self.planes}/1 ! '
                f'{decoder} ! videoconvert ! {caps(self.size)} ! lenssweeptag planes={self.planes}')


class GivenScene(Pictures):
    """A folder of planes with the truth."""

    def __init__(self, folder):
        self.name, self.files = folder.name, sorted(folder.glob('plane_*.png'))
        self.sharp = cv2.imread(str(folder / 'sharp.png'))
        pixels = cv2.imread(str(folder / 'truth.png'), cv2.IMREAD_UNCHANGED)
        self.truth, self.known = depth_in_planes(pixels, self.planes), pixels > 0
        self.size = self.sharp.shape[1::-1]

    def score(self, result, _):
        return {**scores.depth_scores(result.u, self.truth, self.known, self.planes),
                **scores.all_in_focus_scores(result.picture, self.sharp)}


class HaloScene(Pictures):
    """Bright shapes before blank ground `behind` planes farther; made anew for each blur step."""

    def __init__(self, seed, behind):
        self.seed, self.behind, self.name = seed, behind, f'halo {seed}'
        self.size = halo.SIZE

    def source(self, conditions, folder):
        planes, self.sharp, self.truth, self.shapes = halo.stack(self.seed, PLANES, conditions.blur_step, 4, 4 + self.behind)
        self.pictures = np.clip(np.rint(planes), 0, 255).astype(np.uint8)
        self.files = [folder / f'plane_{z}.png' for z in range(PLANES)]
        for file, picture in zip(self.files, self.pictures):
            cv2.imwrite(str(file), picture)
        return super().source(conditions, folder)

    def score(self, result, _):
        everywhere = np.ones_like(self.shapes)
        return {**scores.depth_scores(result.u, self.truth, everywhere, PLANES),
                'shapes_off': float((np.abs(result.u - self.truth) > 1)[self.shapes].mean() * 100),
                **scores.halo_scores(result.picture, self.sharp, self.pictures)}


class RealScene(Pictures):
    """Photographs; aligned, and scored beside the aligned planes."""

    aligned = True

    def __init__(self, folder, farthest_first=False):
        self.name = folder.name
        self.files = sorted((file for file in folder.iterdir() if file.suffix.lower() in ('.png', '.jpg', '.jpeg')),
                            reverse=farthest_first)
        self.size = cv2.imread(str(self.files[0])).shape[1::-1]

    def score(self, result, _):
        return scores.real_scores(result.picture, result.stack)


def scene_in(folder, farthest_first=()):
    """The scene of a folder, or None."""
    if (folder / 'view.png').is_file() and (folder / 'disp.png').is_file():
        return FileScene(folder)
    if (folder / 'truth.png').is_file() and (folder / 'sharp.png').is_file():
        return GivenScene(folder)
    pictures = [file for file in folder.iterdir() if file.suffix.lower() in ('.png', '.jpg', '.jpeg')]
    return RealScene(folder, folder.name in farthest_first) if len(pictures) > 1 else None
