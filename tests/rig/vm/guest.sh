#!/bin/bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# In the virtual machine: brings its devices up, runs the command, leaves its status, and ends the machine.
. /rig-out/environment
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp TMPDIR=/tmp
for word in $(</proc/cmdline); do
    case $word in cache=*|release=*) eval "$word" ;; esac
done

devices() {
    mkdir -p /dev/shm "/lib/modules/$release"
    mount -t tmpfs shm /dev/shm
    mount --bind "$cache/lib/modules/$release" "/lib/modules/$release"
    modprobe -a i2c-dev configfs rig_i2c gpio-sim-rig
    modprobe vivid n_devs=1 node_types=0x1 num_inputs=1 input_types=0x00
    modprobe rig_focus
    modprobe vimc
    mount -t configfs config /sys/kernel/config
    local bank=/sys/kernel/config/gpio-sim/rig/bank
    mkdir -p $bank/line0 $bank/line1
    echo 8 >$bank/num_lines
    echo RUN >$bank/line0/name
    echo SYNC >$bank/line1/name
    echo 1 >/sys/kernel/config/gpio-sim/rig/live
    # What a test needs to find them.
    RIG_LINES=/sys/devices/platform/$(cat /sys/kernel/config/gpio-sim/rig/dev_name)/$(cat $bank/chip_name)
    RIG_CHIP=$(cat $bank/chip_name)
    RIG_I2C=/dev/$(basename "$(dirname "$(grep -l '^rig_i2c$' /sys/class/i2c-dev/*/name)")")
    export RIG_LINES RIG_CHIP RIG_I2C
}

echo "== $(cut -d' ' -f1 /proc/uptime) s: booted"
devices
echo "== $(cut -d' ' -f1 /proc/uptime) s: devices are there"
cd "$(</rig-out/folder)" || exit
eval "$(</rig-out/command)"
status=$?
echo "== $(cut -d' ' -f1 /proc/uptime) s: status $status"
echo $status >/rig-out/status
sync
poweroff -f
