#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# with-bench-camera.sh [BENCH-CAMERA OPTION...] -- COMMAND...: runs a command beside the bench camera, as root, in a network
# namespace that holds nothing else. README.md beside this file has an example.
set -euo pipefail

if [ "${DFF_RIG_NETWORK:-}" != own ]; then
    DFF_RIG_NETWORK=own exec unshare -n "$0" "$@"
fi
ip link set lo up

options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    options+=("$1")
    shift
done
[ $# -gt 1 ] || { echo "usage: $0 [BENCH-CAMERA OPTION...] -- COMMAND..." >&2; exit 2; }
shift

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkfifo ready
bench-camera --run-line=run --sync-line=sync --truth=truth.png "${options[@]}" >ready &
camera=$!
exec 3<ready
read -r line <&3 && [ "$line" = ready ] || { echo "the bench camera does not start" >&2; exit 1; }

status=0
"$@" || status=$?
kill "$camera"
cat <&3
exit "$status"
