# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""dff-studio: a swept lens live in the browser."""


class Unusable(Exception):
    """What the user asked for cannot be had; the text says why, and what to do."""


def missing_typelib(packages):
    """The first of {name: (version, package)} that is not there, in words for the user; empty if all are."""
    import gi
    for name, (version, package) in packages.items():
        try:
            gi.require_version(name, version)
        except ValueError:
            return f'There is no typelib {name} {version}: install {package}'
    return ''
