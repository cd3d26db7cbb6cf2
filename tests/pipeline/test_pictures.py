#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""test_pictures.py SOURCE_ROOT: the documentation's pictures show what the elements make today."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import OpenImageIO

DOCS = pathlib.Path(sys.argv[1], 'docs')


def pixels(path):
    return OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.UINT8).astype(int)


class Pictures(unittest.TestCase):
    def test_they_are_what_their_script_makes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([DOCS / 'pictures.sh', folder], check=True, timeout=120)
            for made in pathlib.Path(folder).iterdir():
                with self.subTest(picture=made.name):
                    now, before = pixels(made), pixels(DOCS / made.name)
                    self.assertEqual(now.shape, before.shape)
                    # Another processor or driver rounds depth otherwise: some pixels cross from one colour to the next.
                    self.assertLess(np.abs(now - before).mean(), 2, 'run docs/pictures.sh inside meson devenv')


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
