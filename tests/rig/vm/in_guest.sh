#!/bin/bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# in_guest.sh TESTS: in the virtual machine, its tests and the pipeline that the documentation prints.
status=0
GTEST_COLOR=no "$1" || status=1
[ -z "${TSAN_OPTIONS:-}" ] || exit $status # gst-launch-1.0 is not sanitized, and cannot load a plug-in that is
echo "== the pipeline as it is printed"
timeout 60 gst-launch-1.0 -q --no-position v4l2src device=/dev/video0 num-buffers=30 ! \
    video/x-raw,format=YUY2,width=320,height=180,framerate=15/1 ! lenssweeptag lens=v4l2:/dev/video0 mode=step planes=3 ! \
    videoconvert ! focalstackmux ! fakesink || status=1
exit $status
