#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# Builds the unit tests of the camera with the thread sanitizer, in build-tsan, and runs them, lenssweepsrc's among them.
# tests/unit/camera/glib_locks.cpp shows the sanitizer GLib's locks.
set -euo pipefail
cd "$(dirname "$0")/.."

[ -f build-tsan/build.ninja ] ||
    meson setup build-tsan -Doptimization=1 -Ddebug=true -Db_sanitize=thread -Db_lundef=false -Dintrospection=disabled
tests=(labeller plane_labels capture lenssweepsrc)
ninja -C build-tsan "${tests[@]/#/tests/unit/camera/test_}" plugins/lenssweep/libgstlenssweep.so plugins/focalstack/libgstfocalstack.so
# What other plug-ins do while the registry is made is not ours to judge.
TSAN_OPTIONS=report_bugs=0 meson test -C build-tsan --no-rebuild 'camera lenssweepsrc' --test-args=--gtest_list_tests >/dev/null
export TSAN_OPTIONS="suppressions=$PWD/tests/thread.supp:exitcode=66" DFF_SEQUENCES=300 DFF_CYCLES=8
meson test -C build-tsan --no-rebuild --print-errorlogs "${tests[@]/#/camera }"
