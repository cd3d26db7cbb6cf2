#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# run.sh [--quick|--linearity] [FOLDER]: times a stack from luma to depth and to all-in-focus picture, stage by stage,
# beside a memory copy and other ways to the same end. Writes bench.md, bench.json and bench.svg to FOLDER
# (bench-results). Ratios hold on a busy machine too, times on an idle one only. --quick: 1920x1080 alone; --linearity:
# from VGA to 4K and from 4 planes to 32, without the others. live.py beside it is the live proof.
set -euo pipefail
part=()
if [[ "${1:-}" = --* ]]; then
    part=("$1")
    shift
fi
folder=$(realpath -m "${1:-bench-results}")
cd "$(dirname "$0")/../.."
. pipelines/setup.sh
install_missing "${run_packages[@]}" "${build_packages[@]}" "${test_packages[@]}"

mkdir -p "$folder" build-release
[ -f build-release/build.ninja ] || meson setup build-release --buildtype=release
ninja -C build-release tests/bench/dff-bench tests/bench/dff-first-stack

say "Measuring"
enter build-release
build-release/tests/bench/dff-bench "$folder/bench.md" "$folder/bench.json" "${part[@]}"
{
    printf '\n## First stack after start, warm kernel caches\n\n'
    for method in paper volume; do
        build-release/tests/bench/dff-first-stack $method >/dev/null
        build-release/tests/bench/dff-first-stack $method
        echo
    done
} >>"$folder/bench.md"
cat "$folder/bench.md"

python=build-release/bench-python/bin/python
[ -x $python ] || python3 -m venv build-release/bench-python
if $python -c 'import matplotlib' 2>/dev/null || $python -m pip install -q matplotlib; then
    $python tests/bench/plot.py "$folder/bench.json" "$folder/bench.svg"
else
    say "No plot: matplotlib is not to be had"
fi
say "Written: $folder"
