#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# pipelines/demo.sh          builds the plug-ins, sweeps the focus of a simulated camera, and leaves the all-in-focus
#                            picture, the depth and a video of both in demo/
# pipelines/demo.sh FOLDER   the same for photographs of one focus sweep: PNG or JPEG, all of one size, sorted by name,
#                            the nearest plane first; aligned before anything else
#
# Installs what is missing if it is root, and says what to install if it is not.
set -euo pipefail
verdict="FAILED, see above"
trap 'echo "demo: $verdict"' EXIT

photos=${1:+$(realpath -- "$1")}
cd "$(dirname "$0")/.."
. pipelines/setup.sh

planes=10 stacks=30 width=640 height=480 rate=25

fail() {
    verdict="FAILED: $*"
    exit 1
}

# launch PIPELINE: runs it to its end; its messages are shown if it fails, and kept in demo/gst-launch.log.
launch() {
    # shellcheck disable=SC2086  # gst-launch takes the pipeline word by word
    timeout 600 gst-launch-1.0 -f $1 >demo/gst-launch.log 2>&1 &
    local process=$!
    # gst-launch-1.0 1.22 may wait for ever after an error that comes early.
    while kill -0 $process 2>/dev/null; do
        sleep 0.2
        ! grep -q '^ERROR' demo/gst-launch.log || kill $process 2>/dev/null || true
    done
    wait $process || {
        cat demo/gst-launch.log
        fail "gst-launch-1.0 did not reach the end"
    }
    grep -E '^WARNING' demo/gst-launch.log || true
}

# seconds: how long the last pipeline ran, without the time it took to start.
seconds() {
    sed -nE 's/^Execution ended after ([0-9]+):([0-9]+):([0-9.]+)$/\1 \2 \3/p' demo/gst-launch.log |
        awk '{ print $1 * 3600 + $2 * 60 + $3 }'
}

# graph SOURCE BLEND: focal stacks from SOURCE through depth and all-in-focus, which leave at d. and c.
graph() {
    echo "$1 ! tee name=s
        s. ! queue ! dffdepth ! tee name=d
        d. ! queue ! c.depth
        s. ! queue ! c.stack  aifcompose name=c blend=$2"
}

# pictures VIDEO: the files of the demo, made from what leaves the graph; VIDEO goes between the two panels and the encoder.
pictures() {
    local window=""
    if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
        window="v. ! queue ! videoconvert ! autovideosink sync=false"
    fi
    echo "c. ! videoconvert ! tee name=a
        a. ! queue ! pngenc ! multifilesink location=demo/all-in-focus.png
        d. ! queue ! depthcolorize ! videoconvert ! tee name=m
        m. ! queue ! pngenc ! multifilesink location=demo/depth.png
        a. ! queue ! videoscale ! p.sink_0  m. ! queue ! videoscale ! p.sink_1
        compositor name=p sink_0::width=$width sink_0::height=$height
            sink_1::xpos=$width sink_1::width=$width sink_1::height=$height !
        $1 videoconvert ! tee name=v
        v. ! queue ! vp8enc deadline=1 target-bitrate=4000000 ! webmmux ! filesink location=demo/side-by-side.webm
        $window"
}

simulated_sweep() {
    local camera="lenssweeptestsrc num-buffers=$((planes * stacks)) planes=$planes rate=$rate seed=1"
    local raw="video/x-raw,format=I420,width=$width,height=$height"
    say "Measuring: $stacks simulated sweeps of $planes planes, ${width}x$height, to depth and all-in-focus"
    launch "$(graph "$camera ! $raw ! focalstackmux" linear) ! fakesink  d. ! queue ! fakesink"
    result="$(awk "BEGIN { printf \"%.1f\", $stacks / $(seconds) }") stacks/s"
    say "$result"
    say "Recording the pictures and the video, with an object that moves"
    launch "$(graph "$camera motion=0.5 ! $raw ! focalstackmux" linear) $(pictures "")"
}

# photo_size FILE DECODER: WIDTHxHEIGHT
photo_size() {
    timeout 60 gst-launch-1.0 -v filesrc "location=\"$1\"" ! "$2" ! fakesink 2>/dev/null |
        sed -nE '/:src: caps = video/s/.*width=\(int\)([0-9]+), height=\(int\)([0-9]+).*/\1x\2/p' | head -n 1
}

photographs() {
    local decoder=pngdec type=image/png files jpegs first="" size number=0 file
    shopt -s nullglob nocaseglob
    files=("$photos"/*.png) jpegs=("$photos"/*.jpg "$photos"/*.jpeg)
    if [ ${#files[@]} -eq 0 ]; then
        decoder=jpegdec type=image/jpeg files=("${jpegs[@]}")
    elif [ ${#jpegs[@]} -gt 0 ]; then
        fail "$photos holds both PNG and JPEG pictures; keep the one kind or the other"
    fi
    planes=${#files[@]}
    [ "$planes" -ge 2 ] || fail "$photos holds $planes PNG or JPEG pictures; a focus sweep has 2 to 64"
    [ "$planes" -le 64 ] || fail "$photos holds $planes pictures; a focus sweep has 2 to 64"
    say "Looking at $planes photographs in $photos"
    local links
    links=$(mktemp -d)
    for file in "${files[@]}"; do
        size=$(photo_size "$file" "$decoder")
        [ -n "$size" ] || fail "$file cannot be read as ${type#image/}"
        : "${first:=$size}"
        [ "$size" = "$first" ] || fail "$file is $size and ${files[0]} is $first; all must have one size"
        ln -s "$file" "$links/$(printf %02d "$number")"
        number=$((number + 1))
    done
    # Panels of the video are at most 960 pixels wide, and even.
    width=${first%x*} height=${first#*x}
    if [ "$width" -gt 960 ]; then
        height=$((height * 960 / width)) width=960
    fi
    width=$((width / 2 * 2)) height=$((height / 2 * 2))

    # Photographs lie farther apart in focus than the planes of a video sweep: hence blend=sharp.
    say "Aligning $planes photographs of $first, then depth and all-in-focus"
    launch "$(graph "multifilesrc location=$links/%02d stop-index=$((planes - 1)) caps=$type,framerate=$planes/1 ! $decoder !
        videoconvert ! lenssweeptag planes=$planes ! focalstackmux ! focalstackalign" sharp) $(pictures "imagefreeze num-buffers=75 !")"
    result="1 stack of $planes photographs in $(seconds | xargs printf '%.1f') s"
    rm -r "$links"
}

[ -z "$photos" ] || [ -d "$photos" ] || fail "$1 is not a folder"
say "Checking that every package is installed"
install_missing "${run_packages[@]}" "${build_packages[@]}" || fail "packages are missing"
say "Building in build/"
build build --buildtype=release -Dtests=disabled || fail "the build"
enter build
mkdir -p demo
rm -f demo/*

if [ -n "$photos" ]; then
    photographs
else
    simulated_sweep
fi

for file in all-in-focus.png depth.png side-by-side.webm; do
    [ -s "demo/$file" ] || fail "demo/$file was not written"
    say "$PWD/demo/$file"
done
verdict="OK, $result, pictures and video in $PWD/demo"
