#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# Builds the unit tests of the camera with the thread sanitizer, in build-tsan, and runs them. The element itself is not among them:
# GStreamer's locks are futexes of GLib's, which the sanitizer does not see.
set -euo pipefail
cd "$(dirname "$0")/.."

[ -f build-tsan/build.ninja ] ||
    meson setup build-tsan -Doptimization=1 -Ddebug=true -Db_sanitize=thread -Db_lundef=false -Dintrospection=disabled
tests=(labeller plane_labels capture)
ninja -C build-tsan "${tests[@]/#/tests/unit/camera/test_}"
export TSAN_OPTIONS="suppressions=$PWD/tests/thread.supp:exitcode=66" DFF_SEQUENCES=300
for test in "${tests[@]}"; do
    "build-tsan/tests/unit/camera/test_$test"
done
