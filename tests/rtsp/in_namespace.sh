#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# in_namespace.sh COMMAND...: runs the command in a network namespace of its own, with nothing in it but the loopback.
[ "$(id -u)" = 0 ] || { echo "A network namespace takes root: skipped"; exit 77; }
exec unshare -n sh -c 'ip link set lo up && exec "$@"' sh "$@"
