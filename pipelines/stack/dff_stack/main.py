# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""From what the user asks for to the files that they want."""
import os
import signal
import sys

import numpy as np

from dff_stack import Unusable, alignment, arguments, batch, depths, engine, listed, memory, order, output, printable, results, slabs, solve, sweep
from dff_stack.progress import Progress, spoken

INTERRUPTS = (signal.SIGINT, signal.SIGTERM)


def list_pictures(pictures):
    for picture in pictures:
        print(f'   {picture.number:2}  {printable(picture)}', flush=True)


def fitting(found, look, most, say):
    """How the pictures lie, found in so many bytes of memory; those that fit the others by no warp are left out."""
    window = alignment.window_for(look.lumas, most - found.bytes_kept)
    aligned = alignment.estimate_most(look.lumas, look.factor, lambda lumas: engine.find_warps(lumas, say), window)
    names = [picture.name for picture in found.pictures]
    blank = [name for name, is_blank in zip(names, aligned.blank) if is_blank]
    if blank:
        say(f'   Nothing by which to align: {listed(blank)}; moved with the neighbours')
    misfits = alignment.misfits(aligned)
    if misfits:
        words = listed([names[number] for number in sorted(misfits)])
        if found.count - len(misfits) < 2:
            raise Unusable(f'The pictures do not fit each other by any shift, turn, zoom or perspective: {words}. '
                           f'--align off takes them as they are')
        say(f'   Left out, since no shift, turn, zoom or perspective brings them onto the others: {words}')
        found.leave_out(misfits)
        look.leave_out(misfits)
    return aligned.without(misfits).warps


def warps_of(options, found, look, most, say, progress):
    width, height = found.size
    if options.align == 'off':
        return [np.eye(3)] * found.count if options.even == 'on' else None
    if options.use_alignment:
        return alignment.load(options.use_alignment, width, height, found.count).warps
    progress.begin(f'Aligning {found.count} pictures', 1)
    return fitting(found, look, most, say)


def spare(pictures, places):
    """Refuses results in the place of pictures that they are made of."""
    for place in places:
        if place.exists() and any(place.samefile(picture.path) for picture in pictures):
            raise Unusable(f'{place} is one of the pictures, and would be lost: give the result another name')


def process(options, progress, tell):
    said = []

    def say(text):
        if text not in said:  # the elements warn in every slab anew
            said.append(text)
            tell(text)

    places = arguments.outputs_of(options).values()
    for place in places:  # before hours of work
        results.check_place(place)
    engine.start()
    pictures, pixel_um = sweep.gather(options.pictures, options.order, options.far_first, say)
    spare(pictures, places)
    if not options.quiet:
        list_pictures(pictures)
    found = sweep.Sweep(pictures, engine.has_deep_colour(), options.preview)
    if min(found.size) < 64:
        raise Unusable(f'a quarter of {pictures[0].size} is too small: leave --preview out')
    if found.loss:
        say(f'   {found.loss}')
    most = memory.to_use(options.memory)
    first_plan = slabs.plan(found.count, *found.size, found.encoding, most, 0, engine.most_side())
    progress.begin(f'Reading {found.count} pictures of {pictures[0].size}', found.count)
    look = found.look_through(first_plan.slabs[0][1], most, progress)
    if options.bad_pixels == 'off':
        found.bad_pixels = ()
    elif len(found.bad_pixels):
        say(f'   {len(found.bad_pixels)} pixels of the sensor are always bright or dark: their neighbours take their place')
    sweep.without_duplicates(found, look, say)
    if options.step:
        depths.take_step(found.pictures, options.step)
    with results.together() as files:
        warps = warps_of(options, found, look, most, say, progress)
        order.tell_of_doubts(found.pictures, look.lumas, look.sharpness, say)
        look.keep_small()
        work = solve.Work(most, options.even == 'on', progress, lambda text: say(f'   {text}'), options.prefer)
        solved = solve.solve(found, warps, work)
        progress.begin('Writing', 1)
        output.Output(options, found, look, solved, warps, pixel_um, said).write(files)
        no_longer_interruptible()
    progress.end()
    tell(f'== {found.count} pictures in {spoken(progress.seconds())}')


def ended(signum, _):
    raise KeyboardInterrupt


def no_longer_interruptible():
    """From here on the results take their names: an interrupt comes too late, and what is there is told as done."""
    for number in INTERRUPTS:
        signal.signal(number, signal.SIG_IGN)


def main(arguments_=None):
    sys.stdout.reconfigure(errors='backslashreplace')  # names may hold any bytes
    sys.stderr.reconfigure(errors='backslashreplace')
    for number in INTERRUPTS:
        signal.signal(number, ended)
    options = arguments.parse(arguments_)
    progress = Progress(quiet=options.quiet)
    say = (lambda text: None) if options.quiet else progress.say
    try:
        if options.batch:
            return 1 if batch.run(options, progress, say) else 0
        process(options, progress, say)
    except (Unusable, OSError, MemoryError, UnicodeError) as error:
        print(f'\ndff-stack: {printable(error) or "there is not enough memory: see --memory"}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        left = 'what is done stays, and the same command goes on' if options.batch else 'nothing was written'
        print(f'\ndff-stack: stopped; {left}', file=sys.stderr, flush=True)
        os._exit(130)  # without waiting for the elements, which may be in the middle of a stack
    return 0
