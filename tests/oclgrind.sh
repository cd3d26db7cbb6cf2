#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# oclgrind.sh [BUILD]: runs the engine's kernels, at small sizes, in a simulator that sees reads and writes outside of
# buffers and data races: the variants for CPUs and for GPUs of method=paper and of the all-in-focus picture, and
# method=volume; and what light fields are made with. To be run by hand (apt install oclgrind); takes some minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build}
command -v oclgrind >/dev/null || { echo "oclgrind.sh: oclgrind is not installed (apt install oclgrind)" >&2; exit 2; }
cache=$(mktemp -d)
trap 'rm -rf "$cache"' EXIT
export XDG_CACHE_HOME=$cache

failed=0
check() { # NAME TEST FILTER
    local log=$cache/log status=0
    # Functions that return structures stay calls: inlined, they have intrinsics that the simulator does not know.
    timeout 900 oclgrind --data-races --max-errors 20 --build-options "-DINLINE=inline -DPREFETCH(address)=" "$build/tests/unit/engine/$2" --gtest_filter="$3" \
        >"$log" 2>&1 || status=$?
    # A test that fails (1) is reported but forgiven: the simulator's mathematics are not the device's.
    if grep -q 'OCLGRIND FATAL ERROR' "$log"; then
        echo "FAIL $1: the simulator gave up: $(grep -A 2 'FATAL ERROR' "$log" | tail -2 | tr '\n' ' ')"
        failed=$((failed + 1))
    elif [ $status -gt 1 ] || grep -qE '^(Invalid|Read-write|Write-write)' "$log" ||
            ! grep -q ' ran\.' "$log"; then
        echo "FAIL $1 (status $status)"
        grep -E '^(Invalid|Read-write|Write-write)' -A 12 "$log" | head -40
        failed=$((failed + 1))
    elif [ $status = 1 ]; then
        echo "ok   $1 (clean, though its results differ from the device's)"
    else
        echo "ok   $1"
    fi
}
check "paper and picture for CPUs, every format" test_memory '*nothing_outside*'
check "paper for CPUs, four levels, odd size" test_cpu_kernels '*FocusTilesShapes*/3:*FocusTilesShapes*/8'
check "paper for CPUs, statistics and solver" test_cpu_kernels '*statistics*:*a_grid_works_again*'
check "focus measure for GPUs" test_focus_measure '*/0:*/4'
check "sparse depth, entropy and Gaussian for GPUs" test_sparse_depth '*'
check "solver for GPUs" test_bilateral_grid '*the_same_engine*'
check "picture for GPUs and CPUs" test_aif '*AifFormats*'
check "sharp picture" test_aif '*SharpFormats*/0:*SharpFormats*/2'
check "volume" test_volume_method '*VolumeShapes*/0:*VolumeShapes*/3:*VolumeShapes*/7'
check "light-field views, panels and colour beside depth" ../lightfield/test_light_field_renderer '*left_over*:*both_kinds*:*rgbd*'
echo "$failed failed"
[ "$failed" = 0 ]
