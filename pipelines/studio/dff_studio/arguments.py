# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What the user asks for."""
import argparse
import pathlib

RIG = ('lenssweeptestsrc is-live=true rate=10 motion=2 near=5 far=0.5 ! video/x-raw,width=640,height=480 ! focalstackmux ! queue leaky=downstream max-size-buffers=1 ! tee name=stacks  '
       'stacks. ! queue ! dffdepth calibration="{calibration}" ! tee name=depth  stacks. ! queue ! aifcompose.stack  '
       'depth. ! queue ! aifcompose.depth  aifcompose name=aifcompose ! identity name=aif')

DESCRIPTION = '''\
Serves a page that shows a swept lens live: all-in-focus picture and depth, the depth as a relief, the planes one by one with a
sharpness curve, and the elements' properties to turn. Any number of browsers look at one capture, which starts with the first.
'''

EPILOG = '''\
THE SOURCE
  --launch takes what dff-rtsp-server takes: any pipeline in the notation of gst-launch-1.0. The element named depth, or any
  element's free source pad of that name, gives depth; aif the all-in-focus picture, planes what is shown where there is none,
  uncertainty what is told beside depth. Confidence, motion and the planes of each stack come from the pipeline's dffdepth by
  themselves.

WHO MAY LOOK
  Without --address, browsers of this machine alone. With it, --accounts and --certificate are needed.

EXAMPLES
  dff-studio
  dff-studio --launch "dffcamerabin source=\\"v4l2src ! lenssweeptag planes=6 near=5 far=0 lens=v4l2:/dev/video0\\""
  dff-studio --address 192.168.1.5 --accounts accounts.ini --certificate server.pem
'''


def rig():
    """The simulated rig's pipeline, with the camera that it has not."""
    calibration = str(pathlib.Path(__file__).with_name('rig.yml'))
    return RIG.format(calibration=calibration.replace('\\', '\\\\').replace('"', '\\"'))


def port(text):
    number = int(text)
    if not 0 <= number <= 65535:
        raise argparse.ArgumentTypeError('a port lies between 0 and 65535')
    return number


def bitrate(text):
    number = int(text)
    if not 100 <= number <= 50000:
        raise argparse.ArgumentTypeError('kilobits a second lie between 100 and 50000')
    return number


def parse(arguments=None):
    parser = argparse.ArgumentParser('dff-studio', description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('-l', '--launch', metavar='PIPELINE', help='source pipeline; default: the simulated rig')
    parser.add_argument('-a', '--address', help='address to listen on, or name of it; 0.0.0.0: all; default: this machine alone')
    parser.add_argument('-p', '--port', type=port, default=8080, help='port to listen on, 0: any; default: 8080')
    parser.add_argument('-f', '--accounts', metavar='FILE', help='let in the users of this file: a line [accounts], then USER=PASSWORD lines')
    parser.add_argument('-c', '--certificate', metavar='FILE', help='serve https:// with the certificate and key of this PEM file')
    parser.add_argument('-b', '--bitrate', type=bitrate, default=2500, metavar='KBIT', help='of each of the two videos; default: 2500')
    options = parser.parse_args(arguments)
    if options.address and not (options.accounts and options.certificate):
        parser.error('--address lets other machines in: give --accounts and --certificate too')
    options.launch = options.launch or rig()
    return options
