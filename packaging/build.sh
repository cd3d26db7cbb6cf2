#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
#
# build.sh [FOLDER]: Debian packages of the last commit to FOLDER (packages), for the Debian it runs on, judged by lintian.
# tests/distribution.sh SUITE packaging/build.sh makes those of another one. Needs debhelper, lintian and what
# packaging/debian/control asks for; installs them if it is root.
set -euo pipefail
folder=$(realpath -m "${1:-packages}")
cd "$(dirname "$0")/.."
. pipelines/setup.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/source" "$work/source/debian"
git archive HEAD | tar -x -C "$work/source"
cp -r packaging/debian/. "$work/source/debian"
install_missing "${run_packages[@]}" "${build_packages[@]}" debhelper dpkg-dev lintian dh-python gobject-introspection
say "Building the packages"
(cd "$work/source" && dpkg-buildpackage --build=binary --no-sign) >"$work/build.log" 2>&1 || { tail -n 60 "$work/build.log"; exit 1; }
mkdir -p "$folder"
cp "$work"/*.deb "$folder"
say "Judging them"
lintian --fail-on error "$work"/*.changes
ls "$folder"
