#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Many clients and rude ones, before a client that must notice nothing, on a server whose memory must not grow.

DFF_RTSP_CYCLES (10) and DFF_RTSP_SECONDS (2) scale it; by hand, try 100 and 60, and fuzz.sh for five minutes of rudeness.
"""
import os
import random
import socket
import time
import unittest

from rtsp_client import Client, Server, Witness

CYCLES = int(os.environ.get('DFF_RTSP_CYCLES', 10))
SECONDS = float(os.environ.get('DFF_RTSP_SECONDS', 2))
LONGEST_SILENCE = 2.0  # seconds; there are 25 frames a second
PIN_SECONDS = 1.5      # a media lives on for so long after its last client
GROWTH_MB = 24         # what allocators may keep
DEPTH = ('videotestsrc is-live=true pattern=snow ! '
         'video/x-raw,format=GRAY16_LE,width=160,height=120,framerate=25/1 ! identity name=depth')


class Endurance(unittest.TestCase):
    def setUp(self):
        self.server = self.enterContext(Server(DEPTH, '--max-clients', '12'))
        for _ in range(3):  # what is loaded and cached once
            self.come_and_go()
        self.witness = Witness(self.server, '/depth')
        self.before = self.server.memory_mb()

    def come_and_go(self):
        with Client(self.server, '/depth') as client:
            self.assertEqual(client.play(), 200)
            client.packet()

    def check(self):
        """To be called last: the witness saw nothing and memory is flat."""
        packets = self.witness.packets
        time.sleep(1)
        after = self.server.memory_mb()
        print(f'{self.id()}: {self.before:.0f} MB before, {after:.0f} MB after, {self.server.threads()} threads, '
              f'longest silence {self.witness.longest_silence:.2f} s', flush=True)
        self.assertIsNone(self.witness.error)
        self.assertGreater(self.witness.packets, packets)
        self.witness.stop()
        self.assertLess(self.witness.longest_silence, LONGEST_SILENCE)
        self.assertLess(after - self.before, GROWTH_MB)

    def test_ten_clients_at_once(self):
        clients = [Client(self.server, '/depth') for _ in range(10)]
        for client in clients:
            self.assertEqual(client.play(), 200)
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            for client in clients:
                client.packet()
        for client in clients:
            client.close()
        self.check()

    def test_clients_come_and_go(self):
        for _ in range(CYCLES):
            self.come_and_go()
        self.check()

    def test_the_capture_starts_and_stops_again_and_again(self):
        self.witness.stop()
        for _ in range(CYCLES // 5):
            self.come_and_go()
            time.sleep(PIN_SECONDS)
        self.witness = Witness(self.server, '/depth')
        self.check()

    def test_a_client_that_stops_reading(self):
        with Client(self.server, '/depth') as client:
            client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            self.assertEqual(client.play(), 200)
            time.sleep(SECONDS)
            self.check()

    def test_clients_that_are_killed(self):
        for _ in range(CYCLES):
            with Client(self.server, '/depth') as client:
                self.assertEqual(client.play(), 200)
                client.packet()
                client.kill()
        self.check()

    def test_malformed_requests(self):
        rude = Fuzzer(self.server, random.Random(1))
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            rude.send_something()
        print(f'{rude.sent} requests, {rude.answers} answers', flush=True)
        self.check()


class Fuzzer:
    """Sends what nobody should: good requests with bytes changed, cut, doubled, or nothing but noise."""

    METHODS = [b'OPTIONS', b'DESCRIBE', b'SETUP', b'PLAY', b'PAUSE', b'TEARDOWN', b'GET_PARAMETER', b'SET_PARAMETER',
               b'ANNOUNCE', b'RECORD', b'GET', b'POST', b'NONSENSE']
    HEADERS = [b'CSeq: 1', b'CSeq: -99999999999999', b'Session: 0123456789', b'Session: ' + b'A' * 5000,
               b'Transport: RTP/AVP;unicast;client_port=1-2', b'Transport: RTP/AVP/TCP;unicast;interleaved=0-255',
               b'Transport: ;;;;====', b'Content-Length: 99999999999', b'Content-Length: -1', b'Content-Length: 10',
               b'Range: npt=now-', b'Range: npt=-nan-1e999', b'Scale: 0', b'Speed: 1e308', b'Require: everything',
               b'Authorization: Basic ////', b'Authorization: Digest username="', b'Blocksize: 1', b'Accept: \xff\xfe',
               b'x-sessioncookie: x', b'If-Match: *', b'']
    URLS = [b'/depth', b'/depth/stream=0', b'/depth/stream=99999999999', b'/', b'*', b'//////', b'/%00%ff', b'/' + b'x' * 3000]

    def __init__(self, server, rng):
        self.server, self.rng, self.sent, self.answers = server, rng, 0, 0

    def request(self):
        rng = self.rng
        url = b'rtsp://127.0.0.1' + rng.choice(self.URLS)
        lines = [rng.choice(self.METHODS) + b' ' + url + rng.choice([b' RTSP/1.0', b' RTSP/9.9', b' HTTP/1.0', b''])]
        lines += rng.sample(self.HEADERS, rng.randrange(5))
        data = bytearray(rng.choice([b'\r\n', b'\n', b'\r']).join(lines) + b'\r\n\r\n')
        for _ in range(rng.choice([0, 0, 1, 5, 50])):
            data[rng.randrange(len(data))] = rng.randrange(256)
        kind = rng.randrange(10)
        if kind == 0:
            return bytes(rng.randbytes(rng.randrange(1, 5000)))
        if kind == 1:
            return b'$' + rng.randbytes(3) + bytes(data)
        if kind == 2:
            return bytes(data[:rng.randrange(len(data))])
        return bytes(data)

    def send_something(self):
        try:
            with socket.create_connection(('127.0.0.1', self.server.port), 5) as connection:
                for _ in range(self.rng.randrange(1, 6)):
                    connection.sendall(self.request())
                    self.sent += 1
                connection.settimeout(0.02)
                self.answers += bool(connection.recv(4096))
        except (ConnectionError, TimeoutError):
            pass  # the server may hang up or wait for more


if __name__ == '__main__':
    unittest.main()
