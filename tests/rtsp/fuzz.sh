#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# fuzz.sh [SECONDS [BUILD]]: malformed requests to dff-rtsp-server for five minutes, in a network namespace (as root), beside a
# client that must notice nothing. tests/run.sh does the same for two seconds.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:-300} build=$(realpath "${2:-../../build}")
set +u # Meson's lines name variables that may not be set.
eval "$(meson devenv -C "$build" --dump)"
set -u
export DFF_RTSP_SECONDS=$seconds DFF_RTSP_SERVER=$build/pipelines/rtsp/dff-rtsp-server
exec ./in_namespace.sh /usr/bin/python3 -B test_endurance.py Endurance.test_malformed_requests
