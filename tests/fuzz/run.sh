#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# run.sh [SECONDS [NAME...]]: fuzzes what reads other people's files and packets, SECONDS (60) in all, shared among the programs
# fuzz_NAME (all). Inputs that reach something new are kept in build-fuzz/corpus, those that end a program in build-fuzz/found;
# put the latter into tests/fuzz/corpus/NAME, which every run begins with.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
. pipelines/setup.sh
seconds=${1:-60}
shift
names=("$@")
[ ${#names[@]} -gt 0 ] || mapfile -t names < <(sed -n "s/^  '\([a-z_]*\)': \[.*/\1/p" tests/fuzz/meson.build)

if [ ! -f build-fuzz/build.ninja ]; then
    CC=clang CXX=clang++ meson setup build-fuzz --buildtype=debugoptimized -Dfuzz=true -Dintrospection=disabled \
        -Db_sanitize=address,undefined -Db_lundef=false '-Dc_args=-fsanitize=fuzzer-no-link -fno-sanitize=alignment' -Dcpp_args=-fsanitize=fuzzer-no-link || exit 1
fi
ninja -C build-fuzz fuzzers >build-fuzz/compile.log || { tail -n 60 build-fuzz/compile.log; exit 1; }

export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1 LSAN_OPTIONS=suppressions=$PWD/tests/sanitizer.supp
export GST_REGISTRY=$PWD/build-fuzz/registry.bin LD_LIBRARY_PATH=$PWD/build-fuzz/plugins/common
failed=0
mkdir -p build-fuzz/found
for name in "${names[@]}"; do
    mkdir -p "build-fuzz/corpus/$name"
    dictionary=()
    [[ $name != *_calibration && $name != lens_profile ]] || dictionary=(-dict=tests/fuzz/settings.dict)
    log=build-fuzz/$name.log
    program=(build-fuzz/tests/fuzz/fuzz_"$name" -timeout=10 -rss_limit_mb=2048 -max_len=16384
        -artifact_prefix="build-fuzz/found/$name-" -print_final_stats=1 "${dictionary[@]}"
        "build-fuzz/corpus/$name" "tests/fuzz/corpus/$name")
    # GLib's own leaks are known by their callers, who are found slowly: leaks are looked for where the corpus is read again.
    if ASAN_OPTIONS=use_sigaltstack=0:detect_leaks=0 "${program[@]}" -max_total_time=$((seconds / ${#names[@]})) >"$log" 2>&1 &&
        ASAN_OPTIONS=use_sigaltstack=0:fast_unwind_on_malloc=0:malloc_context_size=12 "${program[@]}" -runs=0 >"$log.leaks" 2>&1; then
        sed -n "s/^stat::number_of_executed_units: */ok      $name, inputs: /p" "$log"
    else
        failed=1
        echo "FAILED  $name"
        tail -n 40 "$log" "$log.leaks"
    fi
done
exit $failed
