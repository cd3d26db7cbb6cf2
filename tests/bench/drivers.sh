#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# drivers.sh [--times] [PLACE]...: writes docs/drivers.md, what OpenCL drivers make of the self-test's stack and, with --times,
# how long they take, which is of use on an idle machine only. A PLACE is `here`, the folder of a root of another Debian with a
# driver in it (as tests/distribution.sh makes them; only root can enter it), or a driver's library, such as libintelocl.so of
# the Python package intel-opencl-rt. To be run by hand.
set -euo pipefail
cd "$(dirname "$0")/../.."
. pipelines/setup.sh
times=()
if [ "${1:-}" = --times ]; then
    times=(times)
    shift
fi
[ $# -gt 0 ] || set -- here
[ -f build-release/build.ninja ] || meson setup build-release --buildtype=release
ninja -C build-release tests/bench/dff-driver-figures
folder=$(mktemp -d) used=()
trap 'rm -rf "$folder" "${used[@]}"' EXIT
# With the loader of this machine: a driver's folder may hold one of its own, which looks elsewhere.
mkdir "$folder/programs"
cp build-release/tests/bench/dff-driver-figures build-release/plugins/engine/libdffengine.so.0 \
    "$(ldd build-release/tests/bench/dff-driver-figures | awk '$1 == "libOpenCL.so.1" { print $3 }')" "$folder/programs"

# enter_place PLACE: sets `root`, and `variables` for what runs there; its caches are its own.
enter_place() {
    root=/ variables=(LD_LIBRARY_PATH=/tmp/dff-drivers)
    [ ! -d "$1" ] || root=${1%/}/
    [ ! -f "$1" ] || variables=(OCL_ICD_VENDORS="$(realpath -s "$1")"
        LD_LIBRARY_PATH="/tmp/dff-drivers:$(dirname "$(realpath -s "$1")")")
    variables+=(RUSTICL_ENABLE=llvmpipe HOME=/tmp/dff-drivers XDG_CACHE_HOME=/tmp/dff-drivers/cache)
    used+=("${root}tmp/dff-drivers")
    mkdir -p "${root}tmp/dff-drivers"
    cp "$folder"/programs/* "${root}tmp/dff-drivers"
}

# figures STYLE [DEVICE [times]]: the program's lines.
figures() {
    local command=(env "${variables[@]}" DFF_KERNELS="$1" /tmp/dff-drivers/dff-driver-figures "${@:2}")
    if [ "$root" = / ]; then
        timeout 600 "${command[@]}"
    else
        # shellcheck disable=SC2016  # for the shell inside
        timeout 600 unshare --mount sh -c 'root=$1; shift; mount --rbind /proc "$root/proc"; mount --rbind /dev "$root/dev"
            mount --rbind /sys "$root/sys"; exec chroot "$root" "$@"' sh "$root" "${command[@]}"
    fi
}

# row DEVICE
row() {
    local style cells='' driver='' lines status figure
    for style in tiles pixels; do
        status=0
        lines=$(figures $style "$1" "${times[@]}" 2>>"$folder/errors") || status=$?
        [ -n "$driver" ] || driver=$(head -n 1 <<<"$lines" | sed 's/|/ | /')
        mapfile -t figure < <(tail -n +2 <<<"$lines")
        if [ $status = 124 ]; then
            cells+=" | over ten minutes"
        elif [ $status -gt 128 ]; then
            cells+=" | ends the process"
        elif [ $status != 0 ]; then
            cells+=" | fails"
        else
            cells+=" | ${figure[0]} / ${figure[2]}"
        fi
        [ ${#times[@]} = 0 ] || cells+=" | ${figure[1]:-} / ${figure[3]:-}"
    done
    echo "| $driver$cells |"
}

{
    cat <<'END'
# OpenCL drivers

Before a driver is used for the first time it computes a small stack with both methods, which is compared with stored results.
What passes is used, tiles (kernels for CPUs) before pixels (one work-item a pixel); a driver that computes wrong in both styles is
refused by an error that names it. The verdict lies beside the compiled kernels in `~/.cache/gst-plugins-dff` (`*.verdict`, a text)
and is made anew when driver or kernels change. `DFF_KERNELS=tiles` or `DFF_KERNELS=pixels` in the environment forces a style and
asks nobody. Tiles are tried on CPUs of PoCL and of Intel's runtime alone: they use vectors of 32 and 64, which are clang's.

Written by `tests/bench/drivers.sh`. Off: per cent of the places compared, method=paper / method=volume, that are more than a
fiftieth of the sweep off; above 2 the driver is not used so.
END
    if [ ${#times[@]} = 0 ]; then
        printf '\n| driver | device | tiles: off | pixels: off |\n|---|---|---|---|\n'
    else
        printf 'Times: ms a stack of 1920x1080, N=6, from the stack in memory to depth, median of six.\n\n'
        printf '| driver | device | tiles: off | ms | pixels: off | ms |\n|---|---|---|---|---|---|\n'
    fi
    for place in "$@"; do
        enter_place "$place"
        mapfile -t devices < <(figures pixels 2>>"$folder/errors" | sort -u)
        for device in "${devices[@]}"; do
            row "$device"
        done
    done
} >"$folder/table"
cp "$folder/table" docs/drivers.md
cat docs/drivers.md
