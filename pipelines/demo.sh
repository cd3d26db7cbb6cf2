#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# pipelines/demo.sh          builds the plug-ins, sweeps the focus of a simulated camera, and leaves the all-in-focus
#                            picture, the depth and a video of both in demo/
# pipelines/demo.sh FOLDER   builds too, and gives the pictures of one focus sweep in the folder to dff-stack: the same, the
#                            nearest plane first as people count their names, and a video that rocks before the scene
#
# Installs what is missing if it is root, and says what to install if it is not.
set -euo pipefail
photos=${1:+$(realpath -m -- "$1")}
cd "$(dirname "$0")/.."
. pipelines/setup.sh

verdict="FAILED, see above"
finish() {
    jobs -p | xargs -r kill 2>/dev/null || true # a pipeline that still runs when the demo is stopped
    echo "demo: $verdict"
}
trap finish EXIT

fail() {
    verdict="FAILED: $*"
    exit 1
}

planes=10 stacks=30 width=640 height=480 rate=25
patience=1800 # seconds for a pipeline

# launch PIPELINE: runs it to its end; its messages are shown if it fails, and kept in demo/gst-launch.log.
launch() {
    # shellcheck disable=SC2086  # gst-launch takes the pipeline word by word
    timeout "$patience" gst-launch-1.0 -f $1 >demo/gst-launch.log 2>&1 &
    local process=$! status=0
    # gst-launch-1.0 1.22 may wait for ever after an error that comes early.
    while kill -0 $process 2>/dev/null; do
        sleep 0.2
        ! grep -q '^ERROR' demo/gst-launch.log || kill $process 2>/dev/null || true
    done
    wait $process || status=$?
    if [ $status -ne 0 ]; then
        cat demo/gst-launch.log
        [ $status -ne 124 ] || fail "the pipeline took longer than $((patience / 60)) minutes"
        fail "$(sed -nE 's/^(ERROR: from element [^ ]*|WARNING: erroneous pipeline): //p' demo/gst-launch.log | head -n 1 | grep . ||
            echo "gst-launch-1.0 ended with status $status")"
    fi
    grep -E '^WARNING' demo/gst-launch.log || true
}

# seconds: how long the last pipeline ran, without the time it took to start.
seconds() {
    sed -nE 's/^Execution ended after ([0-9]+):([0-9]+):([0-9.]+)$/\1 \2 \3/p' demo/gst-launch.log |
        awk '{ print $1 * 3600 + $2 * 60 + $3 }'
}

# graph SOURCE: focal stacks from SOURCE through depth and all-in-focus, which leave at d. and c.
graph() {
    echo "$1 ! tee name=s
        s. ! queue ! dffdepth ! tee name=d
        d. ! queue ! c.depth
        s. ! queue ! c.stack  aifcompose name=c blend=linear"
}

# pictures: the files of the demo, made from what leaves the graph.
pictures() {
    local window=""
    if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
        window="v. ! queue ! videoconvert ! autovideosink sync=false"
    fi
    echo "c. ! videoconvert ! video/x-raw,format={GRAY16_BE,GRAY8,RGB} ! tee name=a
        a. ! queue ! pngenc ! multifilesink location=demo/all-in-focus.png
        d. ! queue ! depthcolorize ! videoconvert ! tee name=m
        m. ! queue ! pngenc ! multifilesink location=demo/depth.png
        a. ! queue ! videoscale ! p.sink_0  m. ! queue ! videoscale ! p.sink_1
        compositor name=p sink_0::width=$width sink_0::height=$height
            sink_1::xpos=$width sink_1::width=$width sink_1::height=$height !
        videoconvert ! tee name=v
        v. ! queue ! vp8enc deadline=1 target-bitrate=4000000 ! webmmux ! filesink location=demo/side-by-side.webm
        $window"
}

simulated_sweep() {
    local camera="lenssweeptestsrc num-buffers=$((planes * stacks)) planes=$planes rate=$rate seed=1"
    local raw="video/x-raw,format=I420,width=$width,height=$height"
    say "Measuring: $stacks simulated sweeps of $planes planes, ${width}x$height, to depth and all-in-focus"
    launch "$(graph "$camera ! $raw ! focalstackmux") ! fakesink  d. ! queue ! fakesink"
    result="$(awk "BEGIN { printf \"%.1f\", $stacks / $(seconds) }") stacks/s"
    say "$result"
    say "Recording the pictures and the video, with an object that moves"
    launch "$(graph "$camera motion=0.5 ! $raw ! focalstackmux") $(pictures)"
}

photographs() {
    local status=0
    say "The pictures in $photos, the nearest focus first:"
    {
        pipelines/stack/dff-stack "$photos" -o demo/all-in-focus.png --depth-colours demo/depth.png \
            --video demo/rocking.webm 2>&1 >&3 | tee demo/dff-stack.log >&2
    } 3>&1 || status=$?
    [ $status -eq 0 ] || fail "$(tail -n 1 demo/dff-stack.log | sed 's/^dff-stack: //' | grep . || echo "dff-stack ended with status $status")"
    result="the pictures of one sweep"
}

[ $# -le 1 ] || fail "there are $# arguments; it takes one folder, in quotes if its name has spaces"
[ -z "$photos" ] || [ -d "$photos" ] || fail "$photos is not a folder"
say "Checking that every package is installed"
install_missing "${run_packages[@]}" "${build_packages[@]}" || fail "packages are missing"
mkdir -p demo
rm -rf demo/*
say "Building in build/"
build build --buildtype=release -Dtests=disabled || fail "the build"
enter build

video=side-by-side.webm
if [ -n "$photos" ]; then
    photographs
    video=rocking.webm
else
    simulated_sweep
fi

for file in all-in-focus.png depth.png $video; do
    [ -s "demo/$file" ] || fail "demo/$file was not written"
    say "$PWD/demo/$file"
done
verdict="OK, $result, $((SECONDS / 60)) min $((SECONDS % 60)) s in all, pictures and video in $PWD/demo"
