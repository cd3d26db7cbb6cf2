# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A dff-rtsp-server to talk to, and a client of a few lines that can be as rude as a test wants it."""
import os
import re
import signal
import socket
import struct
import subprocess
import threading
import time

PATIENCE = 30  # seconds


class Server:
    """Runs while in its `with` block; must then end by itself, with status 0."""

    def __init__(self, launch, *arguments, address='127.0.0.1'):
        self.address = address
        self.command = [os.environ['DFF_RTSP_SERVER'], '--address', address, '--port', '0', '--launch', launch,
                        *arguments]

    def __enter__(self):
        self.process = subprocess.Popen(self.command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.first_url = self.process.stdout.readline().strip()
        self.port = int(re.search(r':(\d+)/', self.first_url).group(1))
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        status = self.process.wait(PATIENCE)
        self.process.stdout.close()
        assert status == 0, f'dff-rtsp-server ended with status {status}'

    def memory_mb(self):
        with open(f'/proc/{self.process.pid}/status') as status:
            return int(re.search(r'VmRSS:\s*(\d+)', status.read()).group(1)) / 1024

    def threads(self):
        return len(os.listdir(f'/proc/{self.process.pid}/task'))

    def url(self, path):
        return f'rtsp://{self.address}:{self.port}{path}'


class Client:
    """One connection; media comes interleaved on it."""

    def __init__(self, server, path):
        self.url = server.url(path)
        self.socket = socket.create_connection((server.address, server.port), PATIENCE)
        self.stream = self.socket.makefile('rb')
        self.headers = {}
        self.number = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def request(self, method, url=None, **headers):
        """The status and the body of the answer."""
        self.number += 1
        lines = [f'{method} {url or self.url} RTSP/1.0', f'CSeq: {self.number}']
        lines += [f'{name}: {value}' for name, value in {**self.headers, **headers}.items()]
        self.socket.sendall(('\r\n'.join(lines) + '\r\n\r\n').encode())
        return self.answer()

    def answer(self):
        while True:
            first = self.stream.read(1)
            if not first:
                raise ConnectionError('the server closed the connection')
            if first == b'$':
                self.skip_packet()
                continue
            status = int((first + self.stream.readline()).split()[1])
            fields = {}
            while (line := self.stream.readline().strip()):
                name, _, value = line.decode().partition(':')
                fields[name.lower()] = value.strip()
            if 'session' in fields:
                self.headers['Session'] = fields['session'].split(';')[0]
            return status, self.stream.read(int(fields.get('content-length', 0)))

    def skip_packet(self):
        channel, length = struct.unpack('>BH', self.stream.read(3))
        self.stream.read(length)
        return channel

    def play(self):
        """Up to PLAY, over TCP; the status of the first request that was refused, or 200."""
        status, body = self.request('DESCRIBE')
        if status != 200:
            return status
        controls = re.findall(rb'a=control:(stream=\d+)', body)
        for number, control in enumerate(controls):
            transport = f'RTP/AVP/TCP;unicast;interleaved={2 * number}-{2 * number + 1}'
            status, _ = self.request('SETUP', f'{self.url}/{control.decode()}', Transport=transport)
            if status != 200:
                return status
        return self.request('PLAY')[0]

    def packet(self):
        """Waits for one interleaved packet; its channel."""
        while (first := self.stream.read(1)) != b'$':
            if not first:
                raise ConnectionError('the server closed the connection')
        return self.skip_packet()

    def kill(self):
        """Goes without a word, as a client does whose machine loses its power and comes back."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        self.close()

    def close(self):
        self.stream.close()
        self.socket.close()


class Witness(threading.Thread):
    """A well-behaved client that plays all the time and notes the longest silence."""

    def __init__(self, server, path):
        super().__init__(daemon=True)
        self.client = Client(server, path)
        assert self.client.play() == 200
        self.client.packet()
        self.packets = 0
        self.longest_silence = 0.0
        self.error = None
        self.stopping = False
        self.start()

    def run(self):
        try:
            last = time.monotonic()
            while not self.stopping:
                self.client.packet()
                now = time.monotonic()
                self.longest_silence = max(self.longest_silence, now - last)
                last = now
                self.packets += 1
        except (OSError, ConnectionError, struct.error) as error:
            self.error = error

    def stop(self):
        self.stopping = True
        self.join(PATIENCE)
        self.client.close()
