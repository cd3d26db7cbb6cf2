# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""unpack_motorcycle.py WHEEL FOLDER: view.png and disp.png from the wheel of scikit-image 0.17.2."""
import io
import pathlib
import sys
import zipfile

import cv2
import numpy as np

wheel, folder = zipfile.ZipFile(sys.argv[1]), pathlib.Path(sys.argv[2])
(folder / 'view.png').write_bytes(wheel.read('skimage/data/motorcycle_left.png'))
disparity = np.load(io.BytesIO(wheel.read('skimage/data/motorcycle_disp.npz')))['arr_0']
known = np.isfinite(disparity) & (disparity > 0)
levels = np.where(known, disparity / disparity[known].max() * 255, 0)
cv2.imwrite(str(folder / 'disp.png'), np.where(known, np.maximum(np.rint(levels), 1), 0).astype(np.uint8))
