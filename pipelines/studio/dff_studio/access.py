# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Who may look: names this server answers to, pages it talks to, accounts."""
import base64
import hmac
import ipaddress
import secrets
import socket

from gi.repository import GLib

from dff_studio import Unusable

COOKIE = 'dff-studio'
LOOPBACK = {'localhost', '127.0.0.1', '::1'}


def read_accounts(path):
    """The accounts of dff-rtsp-server's file: a line [accounts], then USER=PASSWORD lines."""
    file = GLib.KeyFile()
    try:
        file.load_from_file(path, GLib.KeyFileFlags.NONE)
        users = file.get_keys('accounts')[0]
        accounts = {user: file.get_value('accounts', user) for user in users}
    except GLib.Error as error:
        raise Unusable(f'Cannot read the accounts of {path}: {error.message}') from None
    if not accounts or not all(user and ':' not in user and password for user, password in accounts.items()):
        raise Unusable(f'{path} must hold accounts, each a user, without a colon, and a password')
    return accounts


def split_host(text):
    """Host and port of a Host header, the port as text."""
    if text.startswith('['):
        host, _, rest = text[1:].partition(']')
        return host.lower(), rest.lstrip(':')
    host, _, port = text.partition(':')
    return host.lower(), port


def is_address(host):
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


class Access:
    """`address`: what --address says, None where the server is for this machine alone."""

    def __init__(self, address, accounts):
        self.address, self.accounts = address, accounts
        self.token = secrets.token_urlsafe(32)
        self.names = set(LOOPBACK)
        if address:
            name = socket.gethostname().lower()
            self.names |= {address.lower(), name, f'{name}.local', socket.getfqdn().lower()}

    def refusal(self, headers, secure):
        """Why a request is turned away: status and text; None if it is not. `headers`: by lower-case name.

        A page of elsewhere whose name was made to point here (DNS rebinding) still says that name in Host."""
        host = headers.get('host', '')
        name, _ = split_host(host)
        if name not in self.names and not (self.address and is_address(name)):
            return 421, f'This server does not go by the name {name[:80]!r}'
        origin = headers.get('origin')
        if origin is not None and origin.lower() != f'{"https" if secure else "http"}://{host.lower()}':
            return 403, 'Pages of elsewhere may not talk to this server'
        if headers.get('sec-fetch-site') in ('cross-site', 'same-site') and headers.get('sec-fetch-mode') != 'navigate':
            return 403, 'Pages of elsewhere may not show what is of this server'
        if self.accounts and not self.is_known(headers):
            return 401, 'User and password, please'
        return None

    def is_known(self, headers):
        for part in headers.get('cookie', '').split(';'):
            name, _, value = part.strip().partition('=')
            if name == COOKIE and hmac.compare_digest(value.encode(), self.token.encode()):
                return True
        scheme, _, credentials = headers.get('authorization', '').partition(' ')
        if scheme.lower() != 'basic':
            return False
        try:
            user, _, password = base64.b64decode(credentials, validate=True).decode().partition(':')
        except (ValueError, UnicodeDecodeError):
            return False
        wanted = self.accounts.get(user)
        same = hmac.compare_digest(password.encode(), (wanted or self.token).encode())
        return same and wanted is not None
