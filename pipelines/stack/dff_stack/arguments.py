# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What the user asks for."""
import argparse
import pathlib

from dff_stack import VERSION, memory, order, results

DESCRIPTION = '''\
Makes one picture that is sharp everywhere, and depth, of the pictures of a focus sweep.

PICTURES are files, folders, or TIFF files of several pages: JPEG, PNG, TIFF, EXR, and raw files of cameras, of 8 or 16 bits
or with a point, of one size, two or more of them, as many as there are. The nearest focus comes first, in the order in which
people count (2 before 10); --far-first turns that around. Hand-held is fine: the pictures are aligned, and their brightness is
made even.
'''

EPILOG = '''\
ORDER
  A folder is read in the order of its names, in which people count; files and folders one after the other as they are named.
  --order time takes EXIF's times, --order exif-distance EXIF's focus distances. Where these fall from picture to picture in the
  order of the names, the farthest is taken to be the first, and that is told. A picture that is there twice is taken once.
  Pictures that seem out of order, by EXIF or by what is sharp in them, are named, and so are two sweeps in one folder and
  neighbours that are almost the same. A picture that fits the others by no shift, turn, zoom or perspective is left out, and named.

RESULTS
  The ending of a name says what is written: .tif, .png, .jpg or .exr. All results are written when everything is computed; if
  something fails or Ctrl-C is pressed, none is. TIFF, PNG have the bits of the pictures, JPEG 8, EXR half floats of linear
  light. Of numbers with a point, 1 becomes white, or the brightest where most are above 1, as of photons that were counted.
  EXIF of the first picture, its profile and what was done stand in the file. Pictures are turned upright.
  --depth   TIFF and EXR: numbers with a point, NaN where depth is not known. They are micrometres where the step between
            pictures is known: from --step, an OME-TIFF or ImageJ's TIFF; else plane numbers, 0 for the first picture of the order.
            PNG: 16 bits; the description in the file says what a pixel means, 0 is not known.
  --index   of each pixel the number of the picture in which it is sharp, 1 for the first of the order, 0 where not known. Those
            that are left out are counted too, as in the list at the start; plane numbers of --depth do not count them.
  --cloud, --mesh  in micrometres where the step and the size of a pixel are known; else the depth is stretched to a fifth of the
            width. The mesh is one unit wide, and torn where depth jumps.

SEEN THROUGH
  Hairs, antennae and nets are out of focus in the picture of what lies behind them, which shows through: both are sharp in some
  picture. Of the two that of which there is more to see is kept; --prefer near keeps what is thin, --prefer far the ground. Beside
  edges of what is not thin, near makes it a little larger and far a little smaller.

MEMORY
  What does not fit is computed in slabs of pictures that overlap, whose results become a stack of their own, and in tiles
  side by side, and fewer pictures are matched at once by the alignment. --memory says how much may be used; without it 60 % of
  what is free. What waits for its turn lies in TMPDIR.

MANY STACKS
  dff-stack --batch FOLDER -o RESULTS works through the folders in FOLDER, each a sweep, and writes RESULTS/NAME.tif and
  RESULTS/NAME-depth.tif of each. What is there already is left as it is, so that a batch that was interrupted goes on. One stack
  that fails does not end it; a table at the end names it. --workers N computes N at once in processes of this machine,
  --scheduler tcp://HOST:8786 hands them to a Dask cluster that sees the same folders (package python3-distributed).

EXAMPLES
  dff-stack PHOTOS/ -o result.tif --depth depth.tif
  dff-stack PHOTOS/ -o look.jpg --preview
  dff-stack stage.ome.tif -o sharp.tif --depth heights.tif --cloud heights.ply
  dff-stack LIGHT1/ -o light1.tif --save-alignment rig.json
  dff-stack LIGHT2/ -o light2.tif --use-alignment rig.json

EXIT STATUS
  0 all went well; 1 something could not be done, and the last line says what; 2 the options are wrong; 130 after Ctrl-C.
'''


def amount(text):
    try:
        return memory.bytes_of(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def positive(text):
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float('inf'):
        raise argparse.ArgumentTypeError(f'{text} is no number above 0')
    return value


def ending_in(*endings):
    def path(text):
        if pathlib.Path(text).suffix.lower() not in endings:
            raise argparse.ArgumentTypeError(f'{text} must end in {", ".join(endings)}')
        return text
    return path


def parser():
    made = argparse.ArgumentParser(prog='dff-stack', description=DESCRIPTION, epilog=EPILOG,
                                   formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    made.add_argument('pictures', nargs='*', metavar='PICTURES', help='files and folders')
    made.add_argument('--version', action='version', version=f'dff-stack {VERSION}')
    add_results(made.add_argument_group('what is made'))
    add_order(made.add_argument_group('the sweep'))
    add_work(made.add_argument_group('how it is computed'))
    add_batch(made.add_argument_group('many stacks'))
    return made


def add_results(group):
    picture, depth = ending_in(*results.PICTURE_ENDINGS), ending_in('.tif', '.tiff', '.png', '.exr')
    whole = ending_in('.tif', '.tiff', '.png')
    group.add_argument('-o', '--output', metavar='FILE', help='the picture that is sharp everywhere; a folder with --batch')
    group.add_argument('--depth', metavar='FILE', type=depth, help='depth, in micrometres or plane numbers')
    group.add_argument('--depth-code', metavar='FILE', type=whole, help='depth as 16 bits, from the first plane to the last')
    group.add_argument('--depth-colours', metavar='FILE', type=picture, help='depth for eyes: warm is near, black is not known')
    group.add_argument('--index', metavar='FILE', type=whole, help='which picture each pixel is sharp in')
    group.add_argument('--confidence', metavar='FILE', type=whole, help='how clear the depth of each pixel is, 0 to 255')
    group.add_argument('--cloud', metavar='FILE', type=ending_in('.ply'), help='a point cloud with colours')
    group.add_argument('--mesh', metavar='FILE', type=ending_in('.glb'), help='a surface with the picture on it, for 3D viewers')
    group.add_argument('--report', metavar='FILE', type=ending_in('.html'), help='a page of order, alignment, evenness and depth')
    group.add_argument('--video', metavar='FILE', type=ending_in('.webm'), help='a short video that rocks before the scene')
    group.set_defaults(picture_path=picture)


def add_order(group):
    group.add_argument('--order', choices=order.ORDERS, default='name', help='what the order of the pictures is (%(default)s)')
    group.add_argument('--far-first', action='store_true', help='the first picture of the order has the farthest focus')
    group.add_argument('--step', metavar='UM', type=positive, help='micrometres of focus from picture to picture')
    group.add_argument('--pixel-size', metavar='UM', type=positive, help='micrometres that a pixel shows, for cloud, mesh and TIFF')


def add_work(group):
    group.add_argument('--align', choices=('on', 'off'), default='on', help='undo shake, breathing, turns (%(default)s)')
    group.add_argument('--save-alignment', metavar='FILE', help='write how the pictures lie')
    group.add_argument('--use-alignment', metavar='FILE', help='take that of another sweep of the same rig')
    group.add_argument('--even', choices=('on', 'off'), default='on', help='give all pictures one brightness (%(default)s)')
    group.add_argument('--bad-pixels', choices=('on', 'off'), default='on', help='mend those of the sensor (%(default)s)')
    group.add_argument('--prefer', choices=('clearest', 'near', 'far'), default='clearest',
                       help='what is kept where the ground is seen through something thin and near, as hairs or a net (%(default)s)')
    group.add_argument('--memory', metavar='SIZE', type=amount, help='use at most this much, as 6G or 800M')
    group.add_argument('--preview', action='store_true', help='a quarter of the size, in seconds')
    group.add_argument('--quiet', action='store_true', help='say nothing but what is wrong')


def add_batch(group):
    group.add_argument('--batch', metavar='FOLDER', help='a folder of folders, each a stack; -o names a folder for the results')
    group.add_argument('--workers', metavar='N', type=workers, help='compute N stacks at once, on a Dask cluster started here')
    group.add_argument('--scheduler', metavar='URL', help='hand the stacks to a Dask cluster, as tcp://HOST:8786')


def workers(text):
    if not text.isdecimal() or not 1 <= int(text) <= 256:
        raise argparse.ArgumentTypeError(f'{text} is no number of workers from 1 to 256')
    return int(text)


ONE_STACK_ONLY = ('depth', 'depth_code', 'depth_colours', 'index', 'confidence', 'cloud', 'mesh', 'report', 'video', 'save_alignment', 'pixel_size')


def check_batch(made, options):
    if options.pictures:
        made.error('--batch takes no other pictures than those of its folder')
    if not options.output:
        made.error('name a folder for the results: --batch FOLDER -o RESULTS')
    for name in ONE_STACK_ONLY:
        if getattr(options, name):
            made.error(f'--{name.replace("_", "-")} is for one stack; --batch writes the picture and the depth of each')


def check(made, options):
    """Ends with status 2 where options contradict each other."""
    if options.batch:
        return check_batch(made, options)
    if options.workers or options.scheduler:
        made.error('--workers and --scheduler are for --batch')
    return check_one(made, options)


OUTPUTS = ('output', 'depth', 'depth_code', 'depth_colours', 'index', 'confidence', 'save_alignment', 'cloud', 'mesh', 'video', 'report')


def outputs_of(options):
    """Where each of the wanted results goes."""
    return {name: pathlib.Path(getattr(options, name)) for name in OUTPUTS if getattr(options, name)}


def check_one(made, options):
    if not options.pictures:
        made.error('name the pictures, or a folder of them')
    if not outputs_of(options):
        made.error('say where the result goes: -o result.tif')
    if options.output:
        try:
            options.picture_path(options.output)
        except argparse.ArgumentTypeError as error:
            made.error(f'argument -o/--output: {error}')
    if options.align == 'off' and (options.save_alignment or options.use_alignment):
        made.error('--align off leaves no alignment to save or to use')
    named = [path.resolve() for path in outputs_of(options).values()]
    if len(set(named)) < len(named):
        made.error('two results have the same name')


def parse(arguments=None):
    made = parser()
    options = made.parse_args(arguments)
    check(made, options)
    return options
