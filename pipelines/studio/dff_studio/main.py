# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Starts and ends."""
import logging
import os
import signal
import sys

from dff_studio import Unusable, missing_typelib


def needed():
    """What is not there to be imported, in words for the user; empty if all is."""
    packages = {'Gst': ('1.0', 'gir1.2-gstreamer-1.0'), 'GstVideo': ('1.0', 'gir1.2-gst-plugins-base-1.0'),
                'GstSdp': ('1.0', 'gir1.2-gst-plugins-base-1.0'),
                'GstWebRTC': ('1.0', 'gir1.2-gst-plugins-bad-1.0'), 'Soup': ('3.0', 'gir1.2-soup-3.0'),
                'GstDff': ('1.0', 'the typelib of these plug-ins')}
    try:
        import gi  # noqa: F401
        import numpy  # noqa: F401
    except ImportError as error:
        return f'Python has no module {error.name}: install python3-gi and python3-numpy'
    return missing_typelib(packages)


def serve(options):
    from gi.repository import GLib, Gst, GstSdp, GstWebRTC
    Gst.init(None)
    from dff_studio import frames
    from dff_studio.access import Access, read_accounts
    from dff_studio.studio import Studio
    from dff_studio.web import Web
    frames.load_types()
    frames.load_types(((GstSdp, 'SDPMessage SDPResult'), (GstWebRTC, 'WebRTCICEConnectionState WebRTCSDPType WebRTCSessionDescription')))
    access = Access(options.address, read_accounts(options.accounts) if options.accounts else {})
    addresses = ['127.0.0.1'] if not options.address else []
    studio = Studio(options.launch, addresses, options.bitrate * 1000)
    try:
        web = Web(access, options.certificate, studio.answer, studio.connected)
        web.listen(options.address, options.port)
        loop = GLib.MainLoop()
        for number in (signal.SIGINT, signal.SIGTERM):
            GLib.unix_signal_add(GLib.PRIORITY_HIGH, number, loop.quit)
        for url in web.urls():
            print(url, flush=True)
        loop.run()
        web.end()
    finally:
        studio.end()


def main():
    from dff_studio import arguments
    options = arguments.parse()
    logging.basicConfig(format='dff-studio: %(message)s', level=os.environ.get('DFF_STUDIO_LOG', 'WARNING'))
    if problem := needed():
        print(f'dff-studio: {problem}', file=sys.stderr)
        return 1
    try:
        serve(options)
    except Unusable as error:
        print(f'dff-studio: {error}', file=sys.stderr)
        return 1
    return 0
