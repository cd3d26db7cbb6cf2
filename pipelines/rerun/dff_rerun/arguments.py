# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What the user asks for."""
import argparse

from dff_studio.arguments import rig

VIEWER = 'rerun+http://127.0.0.1:9876/proxy'  # where `rerun` listens

DESCRIPTION = '''\
Hands a swept lens to a rerun viewer, live or as a file: the all-in-focus picture, depth in metres with the camera's pinhole,
confidence, and plots of what the elements count. Ends with the source, or by Ctrl+C.
'''

EPILOG = '''\
THE SOURCE
  --launch takes what dff-studio and dff-rtsp-server take: any pipeline in the notation of gst-launch-1.0. The element named
  depth, or any element's free source pad of that name, gives depth; aif the all-in-focus picture. Confidence comes from the
  pipeline's dffdepth by itself. Metres need depth in dioptres, millimetres or micrometres; points need a calibration.

EXAMPLES
  dff-rerun --save sweep.rrd
  dff-rerun --connect
  dff-rerun --connect rerun+http://192.168.1.5:9876/proxy --launch dffcamerabin
'''


def parse(arguments=None):
    parser = argparse.ArgumentParser('dff-rerun', description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('-l', '--launch', metavar='PIPELINE', help='source pipeline; default: the simulated rig')
    parser.add_argument('-c', '--connect', metavar='URL', nargs='?', const=VIEWER, help=f'hand over to the viewer there; default: {VIEWER}')
    parser.add_argument('-s', '--save', metavar='FILE', help='write this .rrd file')
    options = parser.parse_args(arguments)
    if not options.connect and not options.save:
        parser.error('give --connect for a viewer that runs, --save FILE for a file, or both')
    options.launch = options.launch or rig()
    return options
