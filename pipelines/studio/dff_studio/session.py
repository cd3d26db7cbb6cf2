# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A browser at the other end of a web socket."""
import json
import logging
import time

from gi.repository import GLib, Soup

from dff_studio import Unusable, frames
from dff_studio.video import Viewer
from dff_studio.web import text_of

SILENCE = 150  # seconds; browsers slow a page in the background down to a call a minute
log = logging.getLogger('dff-studio')


def part(message, name):
    """A number from 0 to 1."""
    value = message[name]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value <= 1:
        raise ValueError(f'{name} is no part of 1')
    return float(value)


def number(message):
    value = message.get('frozen') or 0
    if not isinstance(value, int):
        raise ValueError('frozen is no number')
    return value


class Session:
    def __init__(self, studio, connection):
        self.studio, self.connection = studio, connection
        self.viewer = None
        self.heard = time.monotonic()
        connection.connect('message', self.take)
        connection.connect('closed', lambda _: self.end())
        self.answers = {'watch': self.watch, 'answer': self.take_answer, 'candidate': self.take_candidate, 'set': self.set,
                        'probe': self.probe, 'profile': self.profile, 'histogram': self.histogram, 'planes': self.planes,
                        'freeze': self.freeze, 'record': self.record, 'controls': self.controls, 'here': lambda _: None}

    def send(self, message):
        if self.connection.get_state() == Soup.WebsocketState.OPEN:
            self.connection.send_text(text_of(message))

    def take(self, _, kind, data):
        self.heard = time.monotonic()
        if kind != Soup.WebsocketDataType.TEXT:
            return
        try:
            message = json.loads(data.get_data().decode())
            self.answers[message['type']](message)
        except Unusable as error:
            self.send({'type': 'problem', 'text': str(error)})
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            log.debug('A message was not understood: %s', error)
            self.send({'type': 'problem', 'text': f'The server did not understand this: {error}'})

    def look_whether_alive(self):
        if time.monotonic() - self.heard > SILENCE:
            self.end()

    def watch(self, _):
        self.leave()
        if self.studio.video.tracks:
            self.viewer = Viewer(self.studio.video, self.send)

    def take_answer(self, message):
        if self.viewer:
            self.viewer.take_answer(str(message['sdp']))

    def take_candidate(self, message):
        if self.viewer:
            self.viewer.take_candidate(int(message['line']), str(message['candidate']))

    def set(self, message):
        try:
            self.studio.set(message['element'], message['name'], message['value'])
        except Unusable as error:
            self.send({'type': 'problem', 'text': str(error), 'element': message['element'], 'name': message['name']})

    def controls(self, _):
        self.send(self.studio.controls())

    def probe(self, message):
        frozen = number(message)
        known = frames.value_at(self.studio.depth_of(frozen), part(message, 'x'), part(message, 'y'),
                                self.studio.overlays_of(frozen), self.studio.uncertainty_of(frozen))
        self.send({'type': 'probe', **known})

    def profile(self, message):
        line = [part(message, name) for name in ('x0', 'y0', 'x1', 'y1')]
        self.send({'type': 'profile', **frames.profile(self.studio.depth_of(number(message)), *line)})

    def histogram(self, message):
        depth = self.studio.depth_of(number(message))
        self.send({'type': 'histogram', **frames.histogram(depth), 'facts': depth.facts(), 'frozen': number(message)})

    def planes(self, message):
        x, y = part(message, 'x'), part(message, 'y')

        def take(stack):
            try:
                found = stack.sharpness(x, y)
                found.update(type='planes', stack=self.studio.kept_stacks.add(stack), planes=stack.planes)
            except (KeyError, ValueError) as error:
                found = {'type': 'problem', 'text': f'These planes cannot be shown: {error}'}
            GLib.idle_add(self.send, found)
        if not self.studio.stacks.ask(take):
            raise Unusable('This source gives no planes: there is no dffdepth in its pipeline')

    def freeze(self, message):
        """`file`: what it is for, which comes back."""
        self.send({**self.studio.freeze(), 'file': message.get('file')})

    def record(self, message):
        if message['on']:
            self.studio.start_recording()
        else:
            self.studio.stop_recording()

    def leave(self):
        if self.viewer:
            self.viewer.end()
            self.viewer = None

    def end(self):
        self.leave()
        if self.connection.get_state() == Soup.WebsocketState.OPEN:
            self.connection.close(1001, None)
        self.studio.gone(self)
