# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What is being done and how long it will take: a bar on a terminal, a line for each part of the work elsewhere."""
import sys
import time

from dff_stack import printable

BAR = 24
EVERY_S = 0.2


def spoken(seconds):
    minutes, seconds = divmod(int(seconds + 0.5), 60)
    return f'{minutes} min {seconds} s' if minutes else f'{seconds} s'


class Progress:
    def __init__(self, stream=None, quiet=False):
        self.stream = stream or sys.stderr
        self.quiet = quiet
        self.on_terminal = not quiet and self.stream.isatty()
        self.started = self.part_started = time.monotonic()
        self.shown = 0.0
        self.text, self.done, self.all = '', 0, 0

    def begin(self, text, steps):
        """A part of the work that takes so many steps."""
        self.end()
        self.text, self.done, self.all = text, 0, steps
        self.part_started = time.monotonic()
        if self.on_terminal:
            self.draw()
        elif not self.quiet:
            print(f'== {text}', file=self.stream, flush=True)

    def step(self):
        self.done = min(self.done + 1, self.all)
        if self.on_terminal and time.monotonic() - self.shown > EVERY_S:
            self.draw()

    def draw(self):
        self.shown = time.monotonic()
        full = BAR * self.done // max(self.all, 1)
        print(f'\r\033[K[{"#" * full}{"." * (BAR - full)}] {self.text}{self.left()}', end='', file=self.stream, flush=True)

    def left(self):
        """How long this part will take yet, once that can be told."""
        passed = time.monotonic() - self.part_started
        if self.done < 2 or passed < 1 or self.done == self.all:
            return ''
        return f', {spoken(passed * (self.all - self.done) / self.done)} left'

    def say(self, text):
        """A line above the bar."""
        if self.on_terminal:
            print('\r\033[K', end='', file=self.stream)
        print(printable(text), file=self.stream, flush=True)
        if self.on_terminal and self.text:
            self.draw()

    def end(self):
        if self.on_terminal and self.text:
            print('\r\033[K', end='', file=self.stream, flush=True)
        self.text = ''

    def seconds(self):
        return time.monotonic() - self.started
