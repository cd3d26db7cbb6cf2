#!/bin/bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# run_tests.sh CACHE_DIR TESTS: boots the virtual machine, and runs its tests there.
here=$(cd "$(dirname "$0")" && pwd)
gst-inspect-1.0 lenssweeptag >/dev/null || exit 1 # the registry is quick to make here, and slow there
export GST_REGISTRY_UPDATE=no
exec bash "$here/run.sh" "$1" "$here/in_guest.sh" "$2"
