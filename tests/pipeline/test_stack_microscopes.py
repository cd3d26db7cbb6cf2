#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_stack_microscopes.py SOURCE_ROOT: what dff-stack takes from microscopes' files: planes, positions, the size of a pixel."""
import struct
import sys
import unittest

import numpy as np

from gathering import Sweeps
from sweeps import flat, write_pages

from dff_stack import depths, order, sweep, tiff
from dff_stack.progress import Progress


def write_bare_tiff(path, order, is_big, text):
    """A TIFF or BigTIFF file of nothing but a description."""
    data = text.encode() + b'\0'
    if is_big:
        head = {'<': b'II', '>': b'MM'}[order] + struct.pack(order + 'HHHQ', 43, 8, 0, 16)
        table = struct.pack(order + 'QHHQQQ', 1, 270, 2, len(data), 16 + 36, 0)
    else:
        head = {'<': b'II', '>': b'MM'}[order] + struct.pack(order + 'HI', 42, 8)
        table = struct.pack(order + 'HHHIII', 1, 270, 2, len(data), 8 + 18, 0)
    path.write_bytes(head + table + data)


OME = '''<?xml version="1.0"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06"><Image ID="Image:0">
<Pixels ID="Pixels:0" DimensionOrder="XYZCT" Type="uint8" SizeX="96" SizeY="96" SizeZ="3" SizeC="{channels}" SizeT="1"
PhysicalSizeX="0.5" PhysicalSizeY="0.5" PhysicalSizeZ="2" PhysicalSizeZUnit="µm">{planes}</Pixels></Image></OME>'''


class Ome(Sweeps):
    def write(self, planes='', channels=1):
        write_pages(self.photos / 'a.ome.tif', [flat(50 * number) for number in range(3)], OME.format(planes=planes, channels=channels))

    def test_the_step_and_the_size_of_a_pixel_are_taken(self):
        self.write()
        found, pixel_um = sweep.gather([self.photos], 'name', False, self.said.append)
        self.assertEqual([picture.position_um for picture in found], [0, 2, 4])
        self.assertEqual(pixel_um, 0.5)
        depth = np.array([[0, 0.5, np.nan, 2]], np.float32)
        heights, unit, extent = depths.heights(depth, found)
        np.testing.assert_allclose(heights, [[0, 1, np.nan, 4]])
        self.assertEqual((unit, extent), ('micrometres', (0, 4)))

    def test_positions_of_planes_go_before_the_step(self):
        self.write(''.join(f'<Plane TheZ="{z}" TheC="0" TheT="0" PositionZ="{place}" PositionZUnit="mm"/>'
                           for z, place in enumerate((1, 1.5, 1.6))))
        self.assertEqual([picture.position_um for picture in self.gather()], [1000, 1500, 1600])

    def test_a_long_description_is_read_to_its_end(self):
        planes = ''.join(f'<Plane TheZ="{z}" TheC="0" TheT="0" PositionZ="{3 * z}"/>' for z in range(3))
        self.write(f'<TiffData {"x" * 70000}="1"/>' + planes)
        self.assertEqual([picture.position_um for picture in self.gather()], [0, 3, 6])
        for order in '<>':
            for is_big in (False, True):
                write_bare_tiff(self.photos / 'a.ome.tif', order, is_big, OME.format(planes=f'<!--{"y" * 70000}-->' + planes, channels=1))
                self.assertTrue(tiff.description_of(self.photos / 'a.ome.tif').endswith('</OME>'), (order, is_big))

    def test_what_a_damaged_file_promises_is_not_believed(self):
        path = self.photos / 'a.tif'
        for order in '<>':
            for is_big in (False, True):
                write_bare_tiff(path, order, is_big, 'a description')
                whole = path.read_bytes()
                for size in range(1, len(whole)):
                    path.write_bytes(whole[:size])
                    self.assertTrue('a description'.startswith(tiff.description_of(path)), (order, is_big, size))
                for at in range(4, len(whole)):
                    path.write_bytes(whole[:at] + b'\xff' * min(8, len(whole) - at) + whole[at + 8:])
                    self.assertLess(len(tiff.description_of(path)), len(whole), (order, is_big, at))

    def test_no_planes_at_all_are_refused(self):
        write_pages(self.photos / 'a.tif', [flat(0), flat(50)], OME.replace('SizeZ="3"', 'SizeZ="0"').format(planes='', channels=1))
        self.assert_refused('a.tif', 'OME')

    def test_several_channels_are_refused(self):
        self.write(channels=3)
        self.assert_refused('a.ome.tif', '3 channels')

    def test_a_description_that_is_none_is_refused(self):
        write_pages(self.photos / 'a.tif', [flat(0), flat(50)], '<OME><broken')
        self.assert_refused('a.tif', 'OME')

    def test_planes_are_those_that_are_said(self):
        self.write(''.join(f'<TiffData IFD="{page}" FirstZ="{z}"/>' for page, z in enumerate((2, 0, 1))))
        found = self.gather()
        self.assertEqual([picture.page for picture in found], [1, 2, 0])
        self.assertEqual([picture.position_um for picture in found], [0, 2, 4])

    def write_set(self, channels=1, uuid='', name='z{z}c{c}.ome.tif'):
        """A file for each plane, each of which describes all."""
        places = [(z, c) for c in range(channels) for z in range(3)]
        data = ''.join(f'<TiffData FirstZ="{z}" FirstC="{c}" PlaneCount="1"><UUID FileName="z{z}c{c}.ome.tif">urn:{z}{c}</UUID></TiffData>'
                       for z, c in places)
        for z, c in places:
            text = OME.format(planes=data, channels=channels).replace('<OME ', f'<OME {uuid.format(z=z, c=c)} ')
            write_pages(self.photos / name.format(z=z, c=c), [flat(50 * z + c)], text)

    def test_a_set_of_files_has_positions(self):
        self.write_set()
        self.assertEqual([picture.position_um for picture in self.gather()], [0, 2, 4])
        for path in self.photos.iterdir():
            path.unlink()
        self.write_set(uuid='UUID="urn:{z}{c}"', name='renamed{z}.tif')
        self.assertEqual([picture.position_um for picture in self.gather()], [0, 2, 4])
        self.assertEqual(self.said, [])

    def test_of_a_set_one_channel_is_taken(self):
        self.write_set(channels=2)
        self.assert_refused('c1.ome.tif is of channel 1 ', 'of channel 0 ')
        found = self.gather(*(self.photos / f'z{z}c1.ome.tif' for z in range(3)))
        self.assertEqual([picture.position_um for picture in found], [0, 2, 4])

    def test_files_out_of_the_order_of_their_planes_are_told(self):
        self.write_set(uuid='UUID="urn:{z}{c}"', name='{z}.tif')
        (self.photos / '1.tif').rename(self.photos / '9.tif')
        order.tell_of_doubts(self.gather(), [], [], self.said.append)
        self.assertIn('9.tif', self.said[0])

    def test_colours_are_one_channel(self):
        text = OME.format(planes='<Channel ID="Channel:0:0" SamplesPerPixel="3"/>', channels=3)
        write_pages(self.photos / 'a.ome.tif', [flat(50 * number) for number in range(3)], text)
        self.assertEqual([picture.position_um for picture in self.gather()], [0, 2, 4])

    def test_planes_that_are_not_there_are_told(self):
        for pages in (2, 5):
            write_pages(self.photos / 'a.ome.tif', [flat(40 * number) for number in range(pages)], OME.format(planes='', channels=1))
            self.said.clear()
            self.assertEqual([picture.page for picture in self.gather()], list(range(pages)))
            self.assertIn(f'a.ome.tif says that it has 3 planes, and has {pages}', self.said[0])

    def test_more_planes_than_anybody_has_are_not_believed(self):
        write_pages(self.photos / 'a.tif', [flat(0), flat(50)], OME.replace('SizeZ="3"', 'SizeZ="3000000000"').format(planes='', channels=1))
        self.assert_refused('a.tif', 'OME')

    def test_a_stage_that_nobody_asked_stands_still(self):
        self.write(''.join(f'<Plane TheZ="{z}" TheC="0" TheT="0" PositionZ="0"/>' for z in range(3)))
        self.assertEqual([picture.position_um for picture in self.gather()], [0, 2, 4])
        for number in range(3):
            text = OME.replace('SizeZ="3"', 'SizeZ="1"').format(planes='<Plane TheZ="0" TheC="0" TheT="0" PositionZ="7"/>', channels=1)
            write_pages(self.photos / f'a{number}.tif', [flat(50 * number)], text)
        (self.photos / 'a.ome.tif').unlink()
        self.assertFalse(depths.has_positions(self.gather()))

    def test_the_step_goes_on_where_a_page_is_left_out(self):
        write_pages(self.photos / 'a.tif', [flat(tone) for tone in (0, 50, 50, 150)])
        found = sweep.Sweep(self.gather(), False, False)
        sweep.without_duplicates(found, found.look_through(0, 2 ** 30, Progress(quiet=True)), self.said.append)
        depths.take_step(found.pictures, 2.5)
        self.assertEqual([picture.position_um for picture in found.pictures], [0, 2.5, 7.5])
        found.pictures.reverse()
        depths.take_step(found.pictures, 2.5)
        self.assertEqual([picture.position_um for picture in found.pictures], [0, 5, 7.5])


class ImageJ(Sweeps):
    def write(self, *lines, pages=3, a_unit=0.0):
        text = '\n'.join(('ImageJ=1.54f', f'images={pages}', *lines, ''))
        write_pages(self.photos / 'a.tif', [flat(50 * number) for number in range(3)], text, a_unit)

    def test_the_spacing_and_the_size_of_a_pixel_are_taken(self):
        for unit, micrometres in (('micron', 1), ('um', 1), (r'\u00B5m', 1), ('nm', 1e-3), ('mm', 1e3)):
            self.write('slices=3', f'unit={unit}', 'spacing=2.5', a_unit=4.0)
            found, pixel_um = sweep.gather([self.photos], 'name', False, self.said.append)
            np.testing.assert_allclose([picture.position_um for picture in found], np.multiply((0, 2.5, 5), micrometres))
            self.assertAlmostEqual(pixel_um, 0.25 * micrometres)
        self.assertEqual(self.said, [])

    def test_what_is_not_said_is_not_known(self):
        for lines in (('slices=3',), ('slices=3', 'spacing=2'), ('slices=3', 'unit=pixel', 'spacing=2'),
                      ('slices=3', 'unit=um', 'spacing=nan'), ('slices=3', 'unit=um', 'spacing=0'), ('frames=3', 'unit=um', 'spacing=2')):
            self.write(*lines)
            self.assertEqual([picture.position_um for picture in self.gather()], [None] * 3, lines)

    def test_a_sweep_is_one_channel_at_one_time(self):
        self.write('channels=3', 'slices=4', 'hyperstack=true', pages=12)
        self.assert_refused('a.tif has 4 slices of 3 channels', act=self.gather)

    def test_planes_that_are_not_there_are_told(self):
        self.write('slices=900', pages=900)
        self.gather()
        self.assertIn('a.tif says that it has 900 planes, and has 3', self.said[0])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
