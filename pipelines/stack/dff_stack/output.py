# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The results that the user asked for, from what was computed."""
import numpy as np

from dff_stack import Unusable, alignment, arguments, cloud, depths, engine, mesh, report, results, video


class Output:
    """What was computed of a sweep, as the files want it."""

    def __init__(self, options, found, look, solved, warps, pixel_um, said):
        self.options, self.found, self.look, self.solved, self.said = options, found, look, solved, said
        self.warps = warps or alignment.unmoved(found.count).warps
        of_a_pixel = options.pixel_size or pixel_um
        self.pixel_um = of_a_pixel and of_a_pixel * found.shrink
        self.pixels = found.encoding.decode(solved.picture)
        self.depth, self.unit, self.extent = depths.heights(solved.depth, found.pictures)

    def colours(self):
        """The picture in 8 bits."""
        return results.as_file_holds(self.pixels, '.jpg')

    def depth_colours(self):
        return engine.depth_colours(results.code_of(self.solved.depth, 0, self.found.count - 1), lambda text: None)

    def description(self):
        pictures = self.found.pictures
        return (f'{len(pictures)} pictures of a focus sweep, {pictures[0].name} to {pictures[-1].name}, '
                f'{"as they lie" if self.options.align == "off" else "aligned"}, method=volume, blend=sharp')

    def write(self, files):
        for name, path in arguments.outputs_of(self.options).items():
            try:
                getattr(self, f'write_{name}')(files, path)
            except OSError as error:
                raise Unusable(f'{path} cannot be written: {error.strerror or error}') from error

    def write_output(self, files, path):
        results.write_picture(files, path, self.pixels, self.found.pictures[0].spec, self.description(), self.pixel_um)

    def write_depth(self, files, path):
        results.write_depth(files, path, self.depth, self.unit, self.extent, self.pixel_um)

    def write_depth_code(self, files, path):
        results.write_depth_code(files, path, self.depth, self.unit, self.extent, self.pixel_um)

    def write_depth_colours(self, files, path):
        results.write_colours(files, path, self.depth_colours(), 'depth: warm is near, black is not known')

    def write_index(self, files, path):
        of_planes = np.array([picture.number for picture in self.found.pictures])
        planes = np.round(np.nan_to_num(self.solved.depth)).astype(np.int64)
        numbers = np.where(np.isnan(self.solved.depth), 0, of_planes[planes])
        results.write_numbers(files, path, numbers, 'number of the picture in which a pixel is sharp, 0 is not known')

    def write_confidence(self, files, path):
        results.write_numbers(files, path, self.solved.confidence, '255 times the confidence of the depth')

    def write_save_alignment(self, files, path):
        names = [picture.name for picture in self.found.pictures]
        files.begin(path).write_text(alignment.text_of(self.warps, *self.found.size, names))

    def write_cloud(self, files, path):
        of_pixel, of_depth, words = cloud.scales(self.found.size[0], self.extent, self.unit, self.pixel_um)
        cloud.write_ply(files.begin(path), self.depth, self.colours(), of_pixel, of_depth, words)

    def write_mesh(self, files, path):
        of_pixel, of_depth, _ = cloud.scales(self.found.size[0], self.extent, self.unit, self.pixel_um)
        if not mesh.write(files.begin(path), self.depth, self.colours(), self.extent, (of_pixel, of_depth)):
            raise Unusable(f'{path} cannot be written: no depth is known of which to make a surface')

    def write_video(self, files, path):
        unfinished = files.begin(path)
        try:
            video.write(unfinished, self.colours(), self.solved.depth, self.found.count, lambda text: None)
        except (Unusable, UnicodeError) as error:  # of elements, which do not name the file
            raise Unusable(f'{path} cannot be written: {error}') from error

    def write_report(self, files, path):
        title = f'{self.found.pictures[0].path.resolve().parent.name}: {self.found.pictures[0].name} to {self.found.pictures[-1].name}'
        text = report.page(title, self.said, self.found.pictures, self.warps, self.look.lumas, self.solved, self.colours(),
                           self.depth_colours(), self.solved.confidence[:, :, None])
        files.begin(path).write_text(text, errors='xmlcharrefreplace')
