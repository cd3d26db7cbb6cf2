# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# What demo.sh and tests/run.sh share: the packages, and how to build. Sourced by bash, not run.

run_packages=(
    gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-plugins-bad
    gstreamer1.0-plugins-ugly gstreamer1.0-libav pocl-opencl-icd
    glib-networking python3-openimageio python3-numpy python3-gi gir1.2-gstreamer-1.0
    gstreamer1.0-nice gir1.2-gst-plugins-base-1.0 gir1.2-gst-plugins-bad-1.0 gir1.2-soup-3.0)
build_packages=(
    build-essential pkg-config meson ninja-build
    libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev libgstrtspserver-1.0-dev gobject-introspection libgirepository1.0-dev
    ocl-icd-opencl-dev opencl-clhpp-headers opencl-c-headers
    libopencv-dev libopenexr-dev libaravis-dev libusb-1.0-0-dev libgpiod-dev libglm-dev) # Aravis' pkg-config file asks for libusb
test_packages=(
    libgtest-dev libasan8 libubsan1 clang-format clang-tidy clang libclang-rt-dev
    python3-gi gir1.2-gstreamer-1.0 gir1.2-gst-plugins-base-1.0 python3-numpy python3-venv
    iproute2 util-linux gir1.2-aravis-0.8 openssl ffmpeg python3-distributed)

# For the virtual machine of tests/rig/vm, which is one of this kind.
[ "$(dpkg --print-architecture 2>/dev/null)" != amd64 ] || test_packages+=(
    qemu-system-x86 seabios busybox-static kmod cpio v4l-utils linux-headers-amd64 linux-source)

# say TEXT: one line about what happens now, with the minutes and seconds since the start.
say() {
    printf '== %02d:%02d  %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"
}

# install_missing PACKAGE...: installs those that are not there. Touches nothing, and needs no root, when all are.
install_missing() {
    if ! command -v dpkg-query >/dev/null; then
        say "No dpkg here: taking for granted that these, or what they are called here, are installed: $*"
        return 0
    fi
    local missing
    missing=$(comm -23 <(printf '%s\n' "$@" | sort -u) \
        <(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "$@" 2>/dev/null | sed -n 's/ installed$//p' | sort -u))
    [ -n "$missing" ] || return 0
    missing=${missing//$'\n'/ }
    if [ "$(id -u)" != 0 ]; then
        say "Some packages are missing, and only root can install them. Run this, then start again:"
        echo "    sudo apt-get update && sudo apt-get install -y $missing"
        return 1
    fi
    say "Installing $missing"
    export DEBIAN_FRONTEND=noninteractive
    # shellcheck disable=SC2086  # one word a package
    { apt-get update -q && apt-get install -q -y --no-install-recommends -o Dpkg::Use-Pty=0 $missing; } 2>&1 |
        awk '/^(E|W|Err):/ || /newly installed/ { print "   " $0 }
            /^Unpacking/ && ++u % 50 == 0 { print "   " u " packages unpacked" }
            /^Setting up/ && ++n % 50 == 0 { print "   " n " packages set up" }
            { fflush() }'
}

# built_here FOLDER: whether Meson configured the folder where it is now, and not a checkout that was copied or moved.
built_here() {
    python3 -c 'import json, os, sys
places = json.load(open(sys.argv[1] + "/meson-info/meson-info.json"))["directories"]
sys.exit(not (os.path.exists(places["build"]) and os.path.samefile(places["build"], sys.argv[1])))' "$1" 2>/dev/null
}

# build FOLDER OPTION...: configures the folder, once, with these Meson options, and compiles.
build() {
    local folder=$1
    shift
    if [ -f "$folder/build.ninja" ] && ! built_here "$folder"; then
        say "$folder was built in another place: anew"
        rm -r "$folder"
    fi
    mkdir -p "$folder"
    if [ ! -f "$folder/build.ninja" ]; then
        # A configuration that failed leaves a folder that Meson and ninja take for a whole one.
        meson setup "$folder" "$@" >"$folder/setup.log" 2>&1 ||
            { cat "$folder/setup.log"; rm -rf "$folder/build.ninja" "$folder/meson-private" "$folder/meson-info"; return 1; }
    fi
    NINJA_STATUS='   [%f/%t] ' ninja -C "$folder" >"$folder/compile.log" 2>&1 || { tail -n 60 "$folder/compile.log"; return 1; }
}

# enter FOLDER: from here on, this shell sees the plug-ins, libraries and typelibs built in the folder.
enter() {
    local variables
    variables=$(meson devenv -C "$1" --dump) || { echo "$variables"; return 1; }
    set +u # Meson's lines name variables that may not be set.
    eval "$variables"
    set -u
}
