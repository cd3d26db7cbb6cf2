#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# Makes palettes.png, the palettes of depthcolorize side by side. Run it inside `meson devenv`.
set -euo pipefail
cd "$(dirname "$0")"
branches='' sinks='' x=0
for palette in turbo jet gray hue; do
    branches+=" d. ! queue ! depthcolorize palette=$palette ! p.sink_$((x / 160))"
    sinks+=" sink_$((x / 160))::xpos=$x"
    x=$((x + 160))
done
# shellcheck disable=SC2086  # gst-launch takes the pipeline word by word
gst-launch-1.0 -q lenssweeptestsrc num-buffers=6 planes=6 ! video/x-raw,width=160,height=120 ! focalstackmux ! \
    dffdepth name=e e.sparse ! queue ! tee name=d  e.src ! queue ! fakesink \
    $branches compositor name=p background=black $sinks ! videoconvert ! pngenc ! filesink location=palettes.png
