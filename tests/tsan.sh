#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# Builds the unit tests of the camera with the thread sanitizer, in build-tsan, and runs them, lenssweepsrc's among them, and those
# of lenses that are moved through a pipeline or a serial port; then lenssweepsrc against the bench camera, and the lenses that
# the virtual machine has, as root.
# tests/unit/camera/glib_locks.cpp shows the sanitizer GLib's locks. The bench camera renders with OpenCV's threads, which the
# sanitizer does not see: it is BENCH_CAMERA, or build/'s.
set -euo pipefail
cd "$(dirname "$0")/.."

[ -f build-tsan/build.ninja ] ||
    meson setup build-tsan -Doptimization=1 -Ddebug=true -Db_sanitize=thread -Db_lundef=false -Dintrospection=disabled
tests=(labeller plane_labels trigger_count capture lenssweepsrc)
ninja -C build-tsan "${tests[@]/#/tests/unit/camera/test_}" tests/unit/lenssweep/test_{element_lens,optotune,optotune_triangle,testsrc_stream} \
    tests/unit/lens/test_optotune_lens tests/rig/source/rig-proofs tests/rig/vm/rig-vm-tests \
    plugins/lenssweep/libgstlenssweep.so plugins/focalstack/libgstfocalstack.so
# What other plug-ins do while the registry is made is not ours to judge.
TSAN_OPTIONS=report_bugs=0 meson test -C build-tsan --no-rebuild 'camera lenssweepsrc' --test-args=--gtest_list_tests >/dev/null
export TSAN_OPTIONS="suppressions=$PWD/tests/thread.supp:exitcode=66" DFF_SEQUENCES=300 DFF_CYCLES=8
meson test -C build-tsan --no-rebuild --print-errorlogs "${tests[@]/#/camera }"
meson test -C build-tsan --no-rebuild --print-errorlogs 'lens optotune_lens' 'lenssweep optotune' 'lenssweep optotune_triangle' \
    'lenssweep element_lens'
meson test -C build-tsan --no-rebuild --print-errorlogs 'lenssweep testsrc_stream' --test-args='--gtest_filter=TestSrcLatency.*'
export BENCH_CAMERA=${BENCH_CAMERA:-$PWD/build/tests/rig/bench-camera/bench-camera} DFF_RIG_CYCLES=4
if [ -x "$BENCH_CAMERA" ]; then
    meson test -C build-tsan --no-rebuild --print-errorlogs 'rig source lifecycle'
else
    echo "skipped lenssweepsrc against the bench camera: there is no $BENCH_CAMERA"
fi
# fpga:, max14574: and v4l2:. Emulated and sanitized all is so slow that vivid's pictures are not of the times they are stamped
# with. Whether they show the lens at rest is for the release build's tests; here those must end, and without a race.
lens_tests='Sequencer.*:LensDriver.*:VideoLens.*:SubdeviceLens.*:EveryLens.*:StepMode.*:SyncMode.*'
shown='StepMode.frames_show_the_lens*'
export DFF_VM_SECONDS=1500
virtual_machine() { GTEST_FILTER=$1 meson test -C build-tsan --no-rebuild --print-errorlogs -t 5 "${@:2}" 'virtual machine'; }
virtual_machine "$lens_tests:-$shown"
virtual_machine "$shown" --logbase shown >/dev/null || true
log=build-tsan/meson-logs/shown.txt
if ! grep -q '^SKIP:' $log && { grep -q 'ThreadSanitizer' $log || ! grep -qE 'tests? from .* ran' $log; }; then
    cat $log
    exit 1
fi
