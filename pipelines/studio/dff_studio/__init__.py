# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""dff-studio: a swept lens live in the browser."""


class Unusable(Exception):
    """What the user asked for cannot be had; the text says why, and what to do."""
