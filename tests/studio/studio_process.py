# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""dff-studio as a process, and what talks to it without a browser."""
import contextlib
import http.client
import json
import os
import pathlib
import signal
import ssl
import subprocess
import sys
import time

import gi

gi.require_version('Soup', '3.0')
from gi.repository import GLib, Soup  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / 'pipelines/studio/dff-studio'
PATIENCE = 120  # seconds; kernels may have to be compiled, and others may have the processors
# No elements of ours between the source and the page: it is there at once.
PATTERNS = ('videotestsrc is-live=true pattern=ball ! video/x-raw,format=I420,width=160,height=120,framerate=10/1 ! identity name=aif '
            'videotestsrc is-live=true ! video/x-raw,format=GRAY16_LE,width=160,height=120,framerate=10/1,depth-unit=dioptre,'
            'depth-near=5.0,depth-far=0.5 ! identity name=depth')
SWEEP = 'lenssweeptestsrc seed=3 planes=6 near=5 far=0.5 {} ! video/x-raw,format=RGB,width=160,height=120'
RIG = (SWEEP + ' ! focalstackmux ! tee name=stacks  stacks. ! queue ! dffdepth calibration="{calibration}" name=maker ! tee name=depth '
       'stacks. ! queue ! compose.stack  depth. ! queue ! compose.depth  aifcompose name=compose ! identity name=aif')


def rig(source='is-live=true rate=4'):
    return RIG.format(source, calibration=ROOT / 'pipelines/studio/dff_studio/rig.yml')


class Studio:
    """The program while it runs; ends it, and says what it said when it did not end well."""

    def __init__(self, *arguments, port=0):
        self.process = subprocess.Popen([sys.executable, PROGRAM, '--port', str(port), *arguments], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise AssertionError(f'dff-studio ended with status {self.process.wait()}')
        self.port = int(self.url.rstrip('/').rsplit(':', 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            status = self.process.wait(PATIENCE)
        finally:
            self.process.kill()
            self.process.stdout.close()
        if status != 0:
            raise AssertionError(f'dff-studio ended with status {status}')

    def get(self, path, headers=(), context=None):
        """Status and body."""
        kind = http.client.HTTPSConnection if context else http.client.HTTPConnection
        options = {'context': context} if context else {}
        with contextlib.closing(kind('127.0.0.1', self.port, timeout=PATIENCE, **options)) as connection:
            connection.request('GET', path, headers={'Host': f'localhost:{self.port}', **dict(headers)})
            answer = connection.getresponse()
            return answer.status, answer.read()

    def memory(self):
        """Bytes that are resident."""
        fields = pathlib.Path(f'/proc/{self.process.pid}/statm').read_text().split()
        return int(fields[1]) * os.sysconf('SC_PAGE_SIZE')

    def descriptors(self):
        return len(os.listdir(f'/proc/{self.process.pid}/fd'))


class Socket:
    """The web socket of a page. Messages wait in `inbox`."""

    def __init__(self, studio):
        self.inbox = []
        self.connection = None
        self.failure = None
        session = Soup.Session()
        message = Soup.Message.new('GET', f'ws://localhost:{studio.port}/live')
        session.websocket_connect_async(message, None, None, GLib.PRIORITY_DEFAULT, None, self.take_connection)
        self.session = session
        self.wait(lambda: self.connection or self.failure, 'a web socket')
        if self.failure:
            raise AssertionError(self.failure)

    def take_connection(self, session, result):
        try:
            connection = session.websocket_connect_finish(result)
        except GLib.Error as error:
            self.failure = error.message
            return
        connection.set_max_incoming_payload_size(1 << 24)
        connection.connect('message', lambda _, kind, data: self.inbox.append(json.loads(data.get_data())))
        self.connection = connection

    @staticmethod
    def wait(ready, what):
        end = time.monotonic() + PATIENCE
        tick = GLib.timeout_add(50, lambda: True)
        try:
            while not (found := ready()):
                if time.monotonic() > end:
                    raise AssertionError(f'{what} did not come')
                GLib.MainContext.default().iteration(True)
            return found
        finally:
            GLib.source_remove(tick)

    def expect(self, kind, fits=lambda message: True):
        """The next message of that kind that fits."""
        def look():
            while self.inbox:
                message = self.inbox.pop(0)
                if message['type'] == kind and fits(message):
                    return message
            return None
        return self.wait(look, kind)

    def send(self, **message):
        self.connection.send_text(json.dumps(message))

    def ask(self, answer, **message):
        """Until there is no reason to wait any more: before the first frame, everything is a problem."""
        end = time.monotonic() + PATIENCE
        while True:
            self.send(**message)
            found = self.wait(lambda: next((item for item in self.inbox if item['type'] in (answer, 'problem')), None), answer)
            self.inbox.clear()
            if found['type'] == answer or time.monotonic() > end or 'yet' not in found['text']:
                return found
            time.sleep(0.2)

    def close(self):
        self.connection.close(1000, None)
        self.wait(lambda: self.connection.get_state() == Soup.WebsocketState.CLOSED, 'the end of a web socket')


def trusting():
    context = ssl.create_default_context()
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    return context
