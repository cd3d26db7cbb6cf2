# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Files that lie in memory. Where a disk is full, libjpeg ends the program and libpng says nothing; here there is no disk."""
import contextlib
import os


@contextlib.contextmanager
def file():
    """The name of an empty one."""
    number = os.memfd_create('dff-stack')
    try:
        yield f'/proc/self/fd/{number}'
    finally:
        os.close(number)
