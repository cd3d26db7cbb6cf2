#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# oclgrind.sh [BUILD]: runs the engine's kernels, at small sizes, in a simulator that sees reads and writes outside of
# buffers and data races, and holds what they compute there to their twins: the variants for CPUs and for GPUs of
# method=paper and of the all-in-focus picture, and method=volume; and what light fields are made with. To be run by
# hand (apt install oclgrind); takes some minutes.
#
# Two faults of the simulator (21.10) are gone around:
#  - Optimised code widens a comparison of vectors without a sign, and the simulator then takes its "true" for 255, or
#    for -1 in bytes: `int16 n = 0; n -= a > 3;` gives 255 a lane. So nothing is optimised.
#  - max() and min() of a vector of integers and a scalar, which OpenCL has, read what lies behind the scalar:
#    `max(v, 1)`. So kernels write max(v, (int16)1).
# Its --uninitialized is of no use here: it takes all memory of the host that is used in place for uninitialised.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build}
command -v oclgrind >/dev/null || { echo "oclgrind.sh: oclgrind is not installed (apt install oclgrind)" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export XDG_CACHE_HOME=$folder DFF_KERNELS=tiles # the driver is not asked whether it is right: that is what is tested
touch "$folder/failed"

options="-cl-opt-disable -include $PWD/tests/oclgrind.h"

run() { # NAME TEST FILTER
    local log status=0 finding='' start=$SECONDS
    log=$(mktemp -p "$folder")
    timeout 900 oclgrind --data-races --max-errors 20 --build-options "$options" "$build/tests/unit/engine/$2" \
        --gtest_filter="$3" >"$log" 2>&1 || status=$?
    if grep -q 'OCLGRIND FATAL ERROR' "$log"; then
        finding='the simulator gave up'
    elif grep -qE '^(Invalid|Read-write|Write-write)' "$log"; then
        finding='memory or races'
    elif [ $status != 0 ]; then
        finding="status $status"
    elif ! grep -qE '\[  PASSED  \] [1-9]' "$log"; then
        finding='no test has run'
    fi
    if [ -z "$finding" ]; then
        echo "ok   $1 ($((SECONDS - start)) s)"
    else
        echo "$1" >>"$folder/failed"
        echo "FAIL $1: $finding"
        { grep -E '^(Invalid|Read-write|Write-write)|FATAL|Failure' -A 12 "$log" || tail "$log"; } | head -40
    fi
}

check() { # the same, one a processor at a time
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do
        wait -n || true
    done
    run "$@" &
}

check "paper, volume and picture, planes" test_memory '*nothing_outside*/2'
check "luma and reference, every format" test_luma '*'
check "paper for CPUs, four levels, odd size" test_cpu_kernels '*FocusTilesShapes*/3:*FocusTilesShapes*/8'
check "paper for CPUs, statistics" test_cpu_kernels '*statistics*'
check "paper for CPUs, solver and slice" test_cpu_kernels '*LumaGridParameters*/1:*a_grid_works_again*'
check "paper for CPUs, both starts of the solver" test_solver_start '*little*:*another*'
check "focus measure for GPUs" test_focus_measure '*/0:*/4'
check "sparse depth, entropy and Gaussian for GPUs" test_sparse_depth 'SparseDepth.agrees*:GaussianBlur*'
check "solver for GPUs" test_bilateral_grid '*the_same_engine*'
check "picture for GPUs, 16 bits, planes, colours" test_aif '*AifFormats*/9:*AifFormats*/17:*AifFormats*/21:*AifFormats*/49'
check "picture for CPUs, planes, colours, with holes" test_aif '*AifFormats*/2:*AifFormats*/23:*AifFormats*/27:*AifFormats*/35'
check "sharp picture, 16 bits, planes, colours" test_sharp_blend '*SharpStacks*/1:*SharpStacks*/3:*SharpStacks*/5:*SharpStacks*/8'
check "volume at half resolution, 16 bits" test_volume_stages '*/3'
check "volume at a quarter, planes" test_volume_stages '*/4'
check "volume at an eighth" test_volume_stages '*/6'
check "depth that a picture is taken at" test_depth_reach '*'
check "volume as a whole, colours" test_volume_method '*VolumeShapes*/7'
check "sweeps averaged, 16 bits, colours, both styles" test_stack_denoiser '*agrees_with_its_twin*:*between_the_rows*'
check "light-field views, panels and colour beside depth" ../lightfield/test_light_field_renderer \
    '*left_over*:*both_kinds*:*rgbd*:*elemental*'
wait
echo "$(wc -l <"$folder/failed") failed"
[ ! -s "$folder/failed" ]
