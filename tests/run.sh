#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# Builds everything twice, plainly and with the address and undefined-behaviour sanitizers, and runs every test there is.
# Installs what is missing if it is root. Logs stand in the two build folders. The last line counts the tests.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
. pipelines/setup.sh

passed=0 failed=0 skipped=0

finish() {
    if [ "$skipped" -gt 0 ]; then
        echo "$passed passed, $failed failed, $skipped skipped"
    else
        echo "$passed passed, $failed failed"
    fi
    [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
    exit
}

# check NAME COMMAND...: one test; its output is shown when it fails.
check() {
    local name=$1 log
    shift
    log=$(mktemp)
    if "$@" >"$log" 2>&1; then
        passed=$((passed + 1))
        say "ok      $name"
    else
        failed=$((failed + 1))
        say "FAILED  $name"
        tail -n 60 "$log"
    fi
    rm -f "$log"
}

# add_count LOG: adds the last 'N passed, N failed[, N skipped]' that stands alone on a line.
add_count() {
    local count p f s
    count=$(sed -nE 's/^([0-9]+) passed, ([0-9]+) failed(, ([0-9]+) skipped)?$/\1 \2 \4/p' "$1" | tail -n 1)
    [ -n "$count" ] || return 1
    read -r p f s <<<"$count"
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + ${s:-0}))
}

# meson_tests FOLDER: each Meson test counts once.
meson_tests() {
    local log="$1/tests.log" bad
    meson test -C "$1" --no-rebuild --print-errorlogs --num-processes 2 2>&1 | tee "$log" | grep --line-buffered -E '^ *[0-9]+/[0-9]+ '
    number() { sed -nE "s/^($1): +([0-9]+) *$/\2/p" "$log" | awk '{ n += $1 } END { print n + 0 }'; }
    bad=$(number 'Fail|Timeout|Unexpected Pass')
    grep -q '^Ok:' "$log" || bad=1
    passed=$((passed + $(number 'Ok|Expected Fail')))
    failed=$((failed + bad))
    skipped=$((skipped + $(number Skipped)))
    [ "$bad" -eq 0 ] || grep -vE '^ *[0-9]+/[0-9]+ .* OK ' "$log" | tail -n 300
}

say "Checking that every package is installed"
install_missing "${run_packages[@]}" "${build_packages[@]}" "${test_packages[@]}" || { failed=1; finish; }

say "Building in build-release"
check "release build, without a warning" build build-release --buildtype=release -Dwerror=true -Dauto_features=enabled
say "Testing the release build"
meson_tests build-release

say "Building in build-sanitize, with the address and undefined-behaviour sanitizers"
# Line numbers (-g1) are all that the sanitizers tell. They make g++ 12 see uninitialised values where there are none; the release
# build has that warning. GStreamer's byte reader and writer, which only C files use here, are not aligned, by intent.
check "sanitizer build, without a warning" build build-sanitize -Doptimization=g -Ddebug=true -Dwerror=true \
    -Dauto_features=enabled -Dintrospection=disabled -Db_sanitize=address,undefined -Db_lundef=false \
    '-Dcpp_args=-g1 -Wno-error=maybe-uninitialized' '-Dc_args=-g1 -fno-sanitize=alignment'
say "Testing the sanitizer build"
meson_tests build-sanitize

# One core's work in which no clock counts: it goes on beside what follows.
setsid bash fpga/test/run.sh >build-release/fpga.log 2>&1 &
fpga=$!
trap 'kill -- "-$fpga" 2>/dev/null' EXIT

say "Fuzzing what reads files and packets of others"
check "fuzzing, a minute" tests/fuzz/run.sh 60

# Prints a clang-format of version 14, Debian 12's, which others do not format alike: the machine's, or PyPI's.
clang_format_14() {
    local fetched=build-release/format
    if [[ "$(clang-format --version)" == *" version 14."* ]]; then
        echo clang-format
    elif [ -x $fetched/bin/clang-format ] ||
        { python3 -m venv $fetched && $fetched/bin/pip install -q clang-format==14.0.6; } >build-release/format.log 2>&1; then
        echo $fetched/bin/clang-format
    else
        return 1
    fi
}

say "Checking the format of the code"
if format=$(clang_format_14); then
    check "clang-format" bash -c "git ls-files 'pipelines/*.cpp' 'pipelines/*.h' 'plugins/*.cpp' 'plugins/*.c' 'plugins/*.h' 'tests/*.cpp' 'tests/*.c' 'tests/*.h' |
        xargs $format --dry-run -Werror"
else
    skipped=$((skipped + 1))
    say "skipped clang-format: this machine's is not version 14, and pip could not fetch that one (build-release/format.log)"
fi

say "Checking the code with clang-tidy"
check "clang-tidy" python3 tests/tidy.py build-release

say "Checking the evaluation: its scores, and the elements on a small scene"
check "evaluation" env BUILD=build-release tests/eval/run.sh --self-check

say "Testing the FPGA design, which began beside the fuzzing"
wait "$fpga"
cat build-release/fpga.log
add_count build-release/fpga.log || failed=$((failed + 1))

finish
