#!/bin/bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# run_tests.sh CACHE_DIR TESTS: boots the virtual machine, and runs its tests there.
here=$(cd "$(dirname "$0")" && pwd)
# The registry is quick to make here, and slow there. What others' plug-ins do meanwhile is not the thread sanitizer's to judge.
TSAN_OPTIONS=report_bugs=0 "$2" --gtest_list_tests >/dev/null || exit 1
export GST_REGISTRY_UPDATE=no
exec bash "$here/run.sh" "$1" "$here/in_guest.sh" "$2"
