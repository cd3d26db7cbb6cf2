#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# Makes the bitstream of a board: fpga/build.sh arty-z7-20|ulx3s|icebreaker|... (see boards.toml). The tools are unpacked
# from packages into the user's cache; nothing of the machine is changed.
exec "${PYTHON:-python3}" "$(dirname "$0")/flow/build.py" "$@"
