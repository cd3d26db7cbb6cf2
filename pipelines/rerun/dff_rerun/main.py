# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Starts and ends."""
import logging
import signal
import sys

from dff_studio import Unusable, missing_typelib


def needed():
    """What is not there to be imported, in words for the user; empty if all is."""
    try:
        import gi  # noqa: F401
        import rerun  # noqa: F401
    except ImportError as error:
        if error.name == 'gi':
            return 'Python has no module gi: install python3-gi, and make the venv with --system-site-packages'
        return (f'Python has no module {error.name}: `python3 -m venv --system-site-packages ~/rerun`, '
                '`~/rerun/bin/pip install rerun-sdk==0.41.0`, and start dff-rerun by ~/rerun/bin/python3')
    return missing_typelib({'Gst': ('1.0', 'gir1.2-gstreamer-1.0'), 'GstVideo': ('1.0', 'gir1.2-gst-plugins-base-1.0'),
                            'GstDff': ('1.0', 'the typelib of these plug-ins')})


def hand_over(options):
    from gi.repository import GLib, Gst
    Gst.init(None)
    from dff_rerun.recording import Recording
    from dff_studio.frames import load_types
    from dff_studio.source import Source
    load_types()
    loop = GLib.MainLoop()
    recording = Recording(options.connect, options.save)
    try:
        source = Source(options.launch, recording.take_sample, recording.take_state, overlays=('confidence',),
                        convert={'aif': 'videoconvert ! jpegenc quality=90'}, on_end=loop.quit)
        if not source.sinks.keys() & {'depth', 'aif'}:
            raise Unusable('This source gives neither depth nor a picture: there is nothing to hand over')
        recording.source = source
        for number in (signal.SIGINT, signal.SIGTERM):
            GLib.unix_signal_add(GLib.PRIORITY_HIGH, number, loop.quit)
        GLib.timeout_add_seconds(1, recording.plot)
        source.want(True)
        loop.run()
        recording.plot()
        source.end()
    finally:
        recording.end()


def main():
    from dff_rerun import arguments
    options = arguments.parse()
    logging.basicConfig(format='dff-rerun: %(message)s')
    if problem := needed():
        print(f'dff-rerun: {problem}', file=sys.stderr)
        return 1
    try:
        hand_over(options)
    except Unusable as error:
        print(f'dff-rerun: {error}', file=sys.stderr)
        return 1
    return 0
