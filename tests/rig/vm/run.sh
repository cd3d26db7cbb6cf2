#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# run.sh CACHE_DIR COMMAND...: boots a throw-away virtual machine and runs the command, by its absolute path, in it, as
# root. The machine sees this one's files, but writes to them go to its memory. It has a V4L2 camera that can be focused
# (vivid), one whose lens is a sub-device (vimc), the GPIO lines RUN and SYNC (gpio-sim), and an I2C bus with the registers of the sequencer and the lens driver.
# The variables of GStreamer and of this project go with it. Needs no /dev/kvm, and installs no kernel: CACHE_DIR keeps what
# was fetched and built. Ends with the command's status, with 77 and a reason where it cannot run.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cache=$1
shift
seconds=${DFF_VM_SECONDS:-240}

skip() {
    echo "SKIP: $*"
    exit 77
}

[ "$(id -u)" = 0 ] || skip "the virtual machine's disk is this one's root directory, which only root can read whole"
for tool in qemu-system-x86_64 busybox cpio depmod make apt-get; do
    command -v "$tool" >/dev/null || skip "$tool is not installed"
done
source=$(find /usr/src -maxdepth 1 -name 'linux-source-*.tar.xz' | sort -V | tail -n 1)
[ -n "$source" ] || skip "linux-source is not installed"
# The modules are built for the headers that are there, and the kernel must be of their version.
release=$(basename "$(find /lib/modules -maxdepth 2 -path '*-amd64/build' | sort -V | tail -n 1 | xargs -r dirname)")
[ -n "$release" ] || skip "linux-headers-amd64 is not installed"

mkdir -p "$cache/out"
cache=$(cd "$cache" && pwd)
modules=$cache/lib/modules/$release

# Two things that take seconds each, at the same time. Each ends with 77 if it cannot be had here.
fetch_kernel() {
    [ ! -f "$modules/modules.dep" ] || return 0
    cd "$cache" || return # of a subshell
    local fetch=(timeout 60 apt-get -q -o DPkg::Lock::Timeout=30 download "linux-image-$release")
    "${fetch[@]}" >fetch.log 2>&1 || { timeout 60 apt-get -q update && "${fetch[@]}"; } >fetch.log 2>&1 ||
        { tail -n 3 fetch.log; return 77; }
    # Where modules lie, how they are packed and which folders of them there are changes from Debian to Debian.
    dpkg-deb --fsys-tarfile linux-image-"$release"_*.deb >kernel.tar &&
        tar -tf kernel.tar | grep -E '^\./(boot/vmlinuz|(usr/)?lib/modules/[^/]*/(modules\.|kernel/(drivers/(media|i2c|virtio)|fs/(9p|netfs|fscache|overlayfs|configfs)|net/9p)/.*[^/]$))' >kernel.files &&
        tar -xf kernel.tar --transform 's,^\./usr/,./,' -T kernel.files &&
        find lib/modules -name '*.ko.xz' -exec xz -d {} + &&
        sed -i 's/\.ko\.xz/.ko/' "$modules/modules.order" &&
        rm -f linux-image-*.deb kernel.tar
}

build_modules() {
    mkdir -p "$cache/modules" && cd "$cache/modules" || return
    [ ! -f .built ] || [ -n "$(find "$here/modules" -newer .built)" ] || return 0
    cp "$here"/modules/* . &&
        tar -xJf "$source" --transform 's,.*/,,' --occurrence=1 \
            "$(basename "$source" .tar.xz)"/{drivers/gpio/{gpio-sim.c,gpiolib.h},kernel/irq/irq_sim.c} \
            "$(basename "$source" .tar.xz)"/drivers/media/test-drivers/vimc/vimc-{capture,common,core,debayer,lens,scaler,sensor,streamer}.c \
            "$(basename "$source" .tar.xz)"/drivers/media/test-drivers/vimc/vimc-{common,streamer}.h || return
    # Out of the kernel's tree, irq_to_desc() is not to be had.
    sed -i 's/handle_simple_irq(irq_to_desc(\(.*\)));/generic_handle_irq_safe(\1);/' irq_sim.c
    make -C "/lib/modules/$release/build" M="$PWD" modules >build.log 2>&1 || { tail -n 20 build.log; return 1; }
    touch .built
}

build_modules &
building=$!
status=0
(fetch_kernel) || status=$?
[ $status != 77 ] || { wait $building || true; skip "the kernel linux-image-$release cannot be fetched"; }
[ $status = 0 ]
wait $building
mkdir -p "$modules/rig"
cp "$cache"/modules/*.ko "$modules/rig"
depmod -b "$cache" "$release"

# The first root: no more than it takes to reach the second.
first=$cache/initramfs
rm -rf "$first"
mkdir -p "$first"/{bin,dev,proc,sys,modules,lower,memory,root}
cp "$(command -v busybox)" "$first/bin/busybox"
cp "$here/init" "$first/init"
early=$(modprobe -d "$cache" -S "$release" --show-depends -a virtio_pci 9pnet_virtio 9p overlay | awk '$1 == "insmod" { print $2 }' | awk '!seen[$0]++')
for module in $early; do
    cp "$module" "$first/modules"
    basename "$module" >>"$first/modules/order"
done
(cd "$first" && find . | cpio -o -H newc --quiet | gzip -1) >"$cache/initramfs.gz"

rm -f "$cache"/out/*
printf '%q ' "$@" >"$cache/out/command"
export -p | grep -E '^declare -x (GST_|DFF_|GI_|GTEST_|TSAN_|LD_LIBRARY_PATH)' >"$cache/out/environment" || true
pwd >"$cache/out/folder"
cp "$here/guest.sh" "$cache/out/guest.sh"
timeout "$seconds" qemu-system-x86_64 -accel tcg,thread=multi -machine pc -cpu max -smp 2 -m 1024 -display none -no-reboot -nodefaults \
    -serial stdio -monitor none -net none \
    -kernel "$cache/boot/vmlinuz-$release" -initrd "$cache/initramfs.gz" \
    -append "console=ttyS0 quiet panic=-1 mitigations=off no_timer_check cache=$cache release=$release" \
    -virtfs local,path=/,mount_tag=root,security_model=none,readonly=on,multidevs=remap \
    -virtfs local,path="$cache/out",mount_tag=out,security_model=none </dev/null || echo "the virtual machine did not end by itself"
[ -f "$cache/out/status" ] || { echo "the virtual machine gave no status"; exit 1; }
exit "$(cat "$cache/out/status")"
