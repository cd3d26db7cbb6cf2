#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# distribution.sh SUITE [COMMAND...]: tries the last commit on another Debian, as a newcomer would: makes a root of SUITE
# (bookworm, trixie, ...) by debootstrap, clones this checkout into it, and runs pipelines/demo.sh and tests/run.sh there, or
# COMMAND instead. Needs root and the package debootstrap. The root stays for the next time, with what was installed in it,
# in $DFF_ROOTS (/var/tmp/dff-roots), and takes 8 GB; remove it for a fresh one. Of this machine a compiler cache, the certificates
# that it trusts and pip's settings are used.
set -euo pipefail
[ $# -gt 0 ] || { sed -n '5,8s/^# //p' "$0" >&2; exit 2; }
suite=$1
shift
here=$(cd "$(dirname "$0")/.." && pwd)
root=$(realpath -m "${DFF_ROOTS:-/var/tmp/dff-roots}")/$suite
[ "$(id -u)" = 0 ] || { echo "distribution.sh: only root can make and enter a root" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "distribution.sh: debootstrap is not installed (apt install debootstrap)" >&2; exit 2; }

if [ ! -f "$root/made" ]; then
    rm -rf "$root"
    mkdir -p "$root"
    script=/usr/share/debootstrap/scripts/$suite
    [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid # of a suite younger than this debootstrap
    debootstrap --variant=minbase --include=ca-certificates,git,ccache "$suite" "$root" "" "$script"
    printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" # packages start no services
    chmod +x "$root/usr/sbin/policy-rc.d"
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # a root that breaks is made anew
    touch "$root/made"
fi
rm -rf "$root/root/gst-plugins-dff"
git clone -q --no-hardlinks "$here" "$root/root/gst-plugins-dff"
cp /etc/resolv.conf "$root/etc/resolv.conf"
mkdir -p "$root/root/.cache/ccache" "$root/root/.config/ccache"
[ $# -gt 0 ] || set -- bash -c 'pipelines/demo.sh && tests/run.sh'

# Mounts are seen by the command alone and go with it.
# shellcheck disable=SC2016  # for the shell inside
exec unshare --mount --fork --pid --kill-child sh -c '
    set -e
    root=$1 home=$2
    shift 2
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount --rbind /sys "$root/sys"
    for folder in .cache/ccache .config/ccache; do
        [ ! -d "$home/$folder" ] || mount --bind "$home/$folder" "$root/root/$folder"
    done
    for file in /etc/ssl/certs/ca-certificates.crt /etc/pip.conf; do
        [ ! -f "$file" ] || { touch "$root$file" && mount --bind -o ro "$file" "$root$file"; }
    done
    exec chroot "$root" env -i HOME=/root TERM=dumb LC_ALL=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        sh -c "cd /root/gst-plugins-dff && exec \"\$@\"" sh "$@"' sh "$root" "$HOME" "$@"
