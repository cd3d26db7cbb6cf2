#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# pictures.sh [FOLDER]: makes demo.jpg, a sweep's picture and depth, and palettes.png, the palettes of depthcolorize side by side,
# in FOLDER (this one). Run it inside `meson devenv`. A test says when those of this folder are out of date.
set -euo pipefail
cd "${1:-$(dirname "$0")}"

gst-launch-1.0 -q lenssweeptestsrc num-buffers=6 planes=6 seed=1 ! video/x-raw,format=I420,width=640,height=480 ! \
    focalstackmux ! tee name=s  s. ! queue ! dffdepth ! tee name=d  d. ! queue ! c.depth  s. ! queue ! c.stack \
    aifcompose name=c ! queue ! p.sink_0  d. ! queue ! depthcolorize ! p.sink_1 \
    compositor name=p sink_1::xpos=640 ! videoconvert ! jpegenc quality=92 ! filesink location=demo.jpg

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
