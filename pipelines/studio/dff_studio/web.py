# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The page and what it asks for by HTTP, behind the access checks; and the web socket beside it."""
import concurrent.futures
import json
import logging
import pathlib
import re

import gi

gi.require_version('Soup', '3.0')
from gi.repository import Gio, GLib, Soup  # noqa: E402

from dff_studio import Unusable  # noqa: E402
from dff_studio.access import COOKIE  # noqa: E402

LIVE = '/live'  # the web socket
TYPES = {'.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8',
         '.svg': 'image/svg+xml', '.png': 'image/png', '.jpg': 'image/jpeg', '.json': 'application/json', '.exr': 'image/x-exr',
         '.ply': 'model/x-ply', '.bin': 'application/octet-stream', '.mkv': 'video/x-matroska'}
HEADERS = {'Content-Security-Policy': "default-src 'self'; connect-src 'self'; img-src 'self' blob: data:; media-src 'self' blob:; "
                                      "frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
           'X-Content-Type-Options': 'nosniff', 'X-Frame-Options': 'DENY', 'Cross-Origin-Resource-Policy': 'same-origin',
           'Referrer-Policy': 'no-referrer', 'Cache-Control': 'no-store'}
MOST_BYTES = 64 * 1024  # of a message on the web socket
log = logging.getLogger('dff-studio')


def page_folder():
    here = pathlib.Path(__file__).resolve().parents[1]
    return next(folder for folder in (here / 'page', here / 'studio/page') if folder.is_dir())


class Web:
    """`answer(path)` makes the body of what is no file of the page: bytes, a path of a file, or None; a thread of its own calls it.
    `connected(connection)` gets each web socket."""

    def __init__(self, access, certificate, answer, connected):
        self.access, self.answer, self.connected = access, answer, connected
        self.pages = page_folder()
        self.files = {f'/{path.name}': path for path in self.pages.iterdir() if path.suffix in TYPES}
        self.files['/'] = self.files['/index.html']
        self.workers = concurrent.futures.ThreadPoolExecutor(2, 'web')
        self.server = Soup.Server()
        if certificate:
            self.server.set_tls_certificate(read_certificate(certificate))
        self.secure = bool(certificate)
        for path in ('/', LIVE):  # a handler is that of the longest path that fits
            self.server.add_early_handler(path, self.check)
        self.server.add_handler('/', self.serve)
        self.server.add_websocket_handler(LIVE, None, None, self.take_socket)

    def listen(self, address, port):
        options = Soup.ServerListenOptions.HTTPS if self.secure else Soup.ServerListenOptions(0)
        try:
            if not address:
                self.server.listen_local(port, options)
            elif address in ('0.0.0.0', '::'):
                self.server.listen_all(port, options)
            else:
                found = Gio.Resolver.get_default().lookup_by_name(address)
                self.server.listen(Gio.InetSocketAddress.new(found[0], port), options)
        except GLib.Error as error:
            raise Unusable(f'Cannot listen on {address or "localhost"}, port {port}: {error.message}') from None

    def urls(self):
        return [uri.to_string() for uri in self.server.get_uris()]

    def check(self, server, message, path, query):
        """Before the body of a request is read."""
        del server, query
        message.get_request_body().set_accumulate(False)
        headers = {}
        message.get_request_headers().foreach(lambda name, value: headers.setdefault(name.lower(), value))
        refusal = self.access.refusal(headers, self.secure)
        if refusal is None and message.get_method() not in ('GET', 'HEAD'):
            refusal = 405, 'Only GET is understood'
        if refusal:
            status, text = refusal
            log.info('%s %s: %s', path, status, text)
            if status == 401:
                message.get_response_headers().append('WWW-Authenticate', 'Basic realm="dff-studio", charset="UTF-8"')
            self.respond(message, status, 'text/plain; charset=utf-8', text.encode())

    def serve(self, server, message, path, query):
        del server, query
        if file := self.files.get(path):
            if self.access.accounts:
                flags = 'HttpOnly; SameSite=Strict; Path=/' + ('; Secure' if self.secure else '')
                message.get_response_headers().append('Set-Cookie', f'{COOKIE}={self.access.token}; {flags}')
            return self.respond(message, 200, TYPES[file.suffix], file.read_bytes())
        message.pause()
        work = self.workers.submit(self.answer, path)
        work.add_done_callback(lambda done: GLib.idle_add(self.finish, message, path, done))
        return None

    def finish(self, message, path, done):
        try:
            body = done.result()
            status = 200 if body is not None else 404
            kind = TYPES.get(pathlib.PurePath(path).suffix, 'text/plain')
        except Unusable as error:
            status, kind, body = 409, 'text/plain; charset=utf-8', str(error).encode()
        except Exception:  # pylint: disable=broad-except  a browser waits for an answer
            log.exception('%s', path)
            status, kind, body = 500, 'text/plain', b'Something went wrong: see what dff-studio says'
        if isinstance(body, pathlib.Path):
            self.respond_mapped(message, kind, body)
        else:
            self.respond(message, status, kind if body is not None else 'text/plain', b'There is no such thing' if body is None else body)
        message.unpause()
        return GLib.SOURCE_REMOVE

    def respond(self, message, status, kind, body):
        message.set_status(status, None)
        self.add_headers(message)
        message.set_response(kind, Soup.MemoryUse.COPY, body)

    def respond_mapped(self, message, kind, path):
        """A file that may be larger than memory."""
        message.set_status(200, None)
        self.add_headers(message)
        message.get_response_headers().set_content_type(kind, None)
        message.get_response_body().append_bytes(GLib.MappedFile.new(str(path), False).get_bytes())

    @staticmethod
    def add_headers(message):
        for name, value in HEADERS.items():
            message.get_response_headers().replace(name, value)

    def take_socket(self, server, message, path, connection):
        del server, message, path
        connection.set_max_incoming_payload_size(MOST_BYTES)
        self.connected(connection)

    def end(self):
        self.server.disconnect()
        self.workers.shutdown(wait=False, cancel_futures=True)


def read_certificate(path):
    try:
        certificate = Gio.TlsCertificate.new_from_file(path)
    except GLib.Error as error:
        raise Unusable(f'Cannot use the certificate {path}: {error.message}') from None
    if certificate.get_property('private-key-pem') is None:
        raise Unusable(f'There is no private key in {path}: put both into one file, as by `cat key.pem cert.pem > server.pem`')
    return certificate


def parts(path, pattern):
    """The groups of a path that is wholly of the pattern."""
    found = re.fullmatch(pattern, path)
    return found.groups() if found else None


def text_of(message):
    return json.dumps(message, separators=(',', ':'), allow_nan=False)
